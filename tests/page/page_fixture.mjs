// A page of the running heeld, which may not write an error to the console, nor ask another host for anything.

import { test as base, expect } from "@playwright/test";
import { eventually, kToken, Walk } from "./walk.mjs";

export { expect };

/** What a test that breaks the connection on purpose may leave in the console. */
const kOfLostConnection = /ERR_CONNECTION_REFUSED|ERR_CONNECTION_RESET|ERR_EMPTY_RESPONSE|WebSocket connection/;

export const test = base.extend({
  walk: [async ({}, use) => {
    const walk = new Walk();
    try {
      await walk.begin();
      await use(walk);
    } finally {
      await walk.endAll();
    }
  }, { scope: "worker", timeout: 180_000 }],

  /** Whether the test ends heeld. */
  losesConnection: [false, { option: true }],

  operator: async ({ page, walk, losesConnection }, use) => {
    const complaints = [];
    page.on("console", (message) => {
      if (message.type() !== "error" && message.type() !== "warning") return;
      if (losesConnection && kOfLostConnection.test(message.text())) return;
      complaints.push(`console: ${message.text()} (${message.location().url})`);
    });
    page.on("pageerror", (error) => complaints.push(`page: ${error.stack}`));
    page.on("request", (request) => {
      if (new URL(request.url()).host !== new URL(walk.address).host) complaints.push(`another host: ${request.url()}`);
    });
    await use(await Operator.open(page, walk, walk.address));
    expect(complaints).toEqual([]);
  },
});

/** What a person does with the page. */
export class Operator {
  constructor(page, walk) {
    this.page = page;
    this.walk = walk;
  }

  static async open(page, walk, address) {
    // Before the page's own listeners, of which one ends the event.
    await page.addInitScript(() => {
      const note = (event) => (window.pressed_ms ??= performance.timeOrigin + event.timeStamp);
      for (const name of ["pointerdown", "keydown"]) window.addEventListener(name, note, { capture: true });
    });
    await page.goto(address);
    return new Operator(page, walk);
  }

  async signIn(token = kToken) {
    await this.page.getByRole("button", { name: "Sign in", exact: true }).first().click();
    await this.page.locator("#token").fill(token);
    await this.page.keyboard.press("Enter");
  }

  async signedIn() {
    await this.signIn();
    await expect(this.page.locator("#session")).toHaveText("Sign out");
  }

  /** The newest message of this name that the page has. */
  newest(name) {
    return this.page.evaluate((of) => window.heel.bus.newest(of), name);
  }

  /** Until the robot follows and moves. A start can be refused once, while the frames are late on a busy machine. */
  async follow() {
    await eventually(async () => {
      const { state } = (await this.newest("tick")) ?? {};
      if (state === "following" && this.walk.speed_m_s() > 0.1) return true;
      if (state === "emergency") await this.page.locator("#reset").click();
      else if (state === "idle" || state === "stopped") await this.page.locator("#start").click();
      await this.page.waitForTimeout(100);
      return false;
    }, "the robot follows");
  }

  /**
   * Within which time zero must be on the wire: 100 ms; on a busy machine ten times what the browser's smallest request takes now.
   */
  async bound_ms() {
    const request_ms = await this.page.evaluate(async () => {
      const times_ms = [];
      for (let i = 0; i < 9; ++i) {
        const begin_ms = performance.now();
        await fetch("api/info");
        times_ms.push(performance.now() - begin_ms);
      }
      return times_ms.sort((a, b) => a - b)[4];
    });
    return Math.max(100, 10 * request_ms);
  }

  /**
   * Lets `press` stop the robot and says after how many milliseconds zero was on the wire. Several attempts, because the machine may
   * be busy: the best one counts.
   */
  async stoppedAfter_ms(press, goal_ms = 100) {
    let best_ms = Infinity;
    for (let attempt = 0; attempt < 3 && best_ms > goal_ms; ++attempt) {
      await this.follow();
      best_ms = Math.min(best_ms, await this.zeroAfter_ms(press));
      await expect(this.page.locator("#sentence")).toHaveText("At rest: emergency stop");
      expect((await this.newest("tick")).state).toBe("emergency");
    }
    return best_ms;
  }

  /** After how many milliseconds from the press zero was on the wire. */
  async zeroAfter_ms(press) {
    const pressed_s = await this.pressedAt_s(press);
    const zero_s = await eventually(() => this.walk.firstZero_s(pressed_s), "zero on the wire");
    return (zero_s - pressed_s) * 1000;
  }

  /** When the browser got the press, in seconds of CLOCK_MONOTONIC. */
  async pressedAt_s(press) {
    await this.page.evaluate(() => (window.pressed_ms = undefined));
    await press();
    const pressed_ms = await this.page.evaluate(() => window.pressed_ms);
    const wallMinusMonotonic_s = Date.now() / 1000 - Number(process.hrtime.bigint()) * 1e-9;
    return pressed_ms / 1000 - wallMinusMonotonic_s;
  }

  /** Writes the picture page-`name`.jpg. The pointer rests on nothing that would look chosen. */
  async screenshot(name, folder) {
    await this.page.mouse.move(0, 0);
    await this.page.screenshot({ path: `${folder}/page-${name}.jpg`, type: "jpeg", quality: 76 });
  }
}
