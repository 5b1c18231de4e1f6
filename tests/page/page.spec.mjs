// The page as people use it: look, sign in, follow, stop, tune, lose heeld. The person walks on all the time, so that what needs them in
// view comes first.

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { HangingProxy } from "./hanging_proxy.mjs";
import { expect, Operator, test } from "./page_fixture.mjs";
import { eventually } from "./walk.mjs";

const kDesktop = { width: 1440, height: 900 };
const kPhone = { width: 390, height: 844 };
const kAxe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const screenshots = () => test.info().config.metadata.screenshots;

const kRules = { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"] };

/** Nothing that axe-core finds wrong, and no control without a name. */
async function expectAccessible(page, rules = kRules) {
  // Not as an added script: the Content-Security-Policy allows none.
  await page.evaluate(kAxe);
  const result = await page.evaluate((which) => window.axe.run(document, which), rules);
  const found = result.violations.map(({ id, help, nodes }) => `${id}: ${help}: ${nodes.map((node) => node.html.slice(0, 120)).join(" | ")}`);
  expect(found).toEqual([]);
}

/** How many pixels of the picture are of the quadrilateral's colour, and how different the others are. */
function pictureContent(page) {
  return page.evaluate(() => {
    const canvas = document.getElementById("picture");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let yellow = 0;
    const greys = new Set();
    for (let i = 0; i < data.length; i += 4) {
      if (data[i] > 200 && data[i + 1] > 170 && data[i + 2] < 90) ++yellow;
      greys.add(data[i]);
    }
    return { yellow, greys: greys.size };
  });
}

test.describe("desktop, walking", () => {
  test.use({ viewport: kDesktop });

  test("shows state, reason and picture to everybody, and asks for a token before it moves", async ({ operator, page }) => {
    await expect(page.locator("#sentence")).toHaveText("At rest: not started");
    await expect(page.locator("#advice")).toContainText("Press Start");
    await expect(page.locator("#chip-link")).toHaveText("robot");
    await expect(page.locator("#chip-battery")).toHaveText(/\d\d\.\d V/);
    await expect.poll(async () => (await pictureContent(page)).greys).toBeGreaterThan(50);
    await expect(page.locator("#control-note")).toContainText("sign in first");
    await page.locator("#start").click();
    await operator.page.locator("#token").fill("a token that is not the right one");
    await page.keyboard.press("Enter");
    await expect(page.locator("#sign-in-error")).not.toBeEmpty();
    await expect(page.locator("#session")).toHaveText("Sign in");
    expect((await operator.newest("tick")).state).toBe("idle");
    await page.keyboard.press("Escape");
    await operator.signedIn();
    await expect(page.locator("#control-note")).toBeEmpty();
  });

  test("follows after Start, with the quadrilateral on the shirt", async ({ operator, page, walk }) => {
    await operator.signedIn();
    await operator.follow();
    await expect(page.locator("#sentence")).toHaveText("Following");
    await expect.poll(async () => (await pictureContent(page)).yellow).toBeGreaterThan(200);
    const { quad, position_m } = await operator.newest("pose");
    const [, , , height_px] = walk.region.split(",").map(Number);
    const [upper, lower] = [quad[0][1], quad[3][1]];
    // As high as the taught region appears at this distance.
    expect((lower - upper) / ((height_px * 1.5) / position_m[2])).toBeGreaterThan(0.85);
    expect((lower - upper) / ((height_px * 1.5) / position_m[2])).toBeLessThan(1.15);
    expect(Math.abs((quad[0][0] + quad[1][0]) / 2 - 320)).toBeLessThan(120);
    const { predicted, inlier_px } = await eventually(async () => {
      const pose = await operator.newest("pose");
      return pose.inlier_px?.length > 20 && pose.predicted ? pose : undefined;
    }, "inliers and predicted region");
    const within = (x, y, [x0, y0, x1, y1]) => x >= x0 && x <= x1 && y >= y0 && y <= y1;
    expect(inlier_px.every(([x, y]) => within(x, y, predicted))).toBe(true);
    expect(within(quad[0][0], quad[0][1], predicted)).toBe(true);
    // Soon after they are taken.
    const ages_ms = await page.evaluate(() => new Promise((done) => {
      const { bus } = window.heel;
      const ages = [];
      bus.on("drawn", ({ t_s }) => {
        // One clock: the daemon's wall clock is that of this machine.
        const tick = bus.newest("tick");
        ages.push(Date.now() - (tick.wall_ms + (t_s - tick.t_s) * 1000));
        if (ages.length === 45) done(ages.sort((a, b) => a - b));
      });
    }));
    const at = (share) => Math.round(ages_ms[Math.floor(share * (ages_ms.length - 1))]);
    console.log(`picture from exposure to drawn: p50 ${at(0.5)} ms, p95 ${at(0.95)} ms, most ${at(1)} ms`);
    expect(at(0.5)).toBeGreaterThan(0);
    expect(at(0.5)).toBeLessThan(500);
    await operator.screenshot("following", screenshots());
  });

  test("stops by the button and by the space bar within 100 ms, wherever the focus is", async ({ operator, page }) => {
    await operator.signedIn();
    const button_ms = await operator.stoppedAfter_ms(() => page.locator("#estop").click());
    await page.locator("#tab-settings").click();
    await page.getByLabel("control.gain_yaw_1_s", { exact: true }).focus();
    const space_ms = await operator.stoppedAfter_ms(() => page.keyboard.press("Space"));
    console.log(`zero on the wire after the button: ${button_ms.toFixed(0)} ms, after the space bar: ${space_ms.toFixed(0)} ms`);
    expect(button_ms).toBeLessThan(100);
    expect(space_ms).toBeLessThan(100);
    await operator.screenshot("emergency", screenshots());
    await page.locator("#reset").click();
    await expect(page.locator("#sentence")).toHaveText("At rest: not started");
    // On a button the space bar stops and does not press; in a text field it writes, and after Esc it stops.
    await page.locator("#start").focus();
    await page.keyboard.press("Space");
    await expect(page.locator("#sentence")).toHaveText("At rest: emergency stop");
    await page.locator("#reset").click();
    await expect(page.locator("#sentence")).toHaveText("At rest: not started");
    await page.locator("#setting-search").click();
    await page.keyboard.type("yaw gain");
    await expect(page.locator("#setting-search")).toHaveValue("yaw gain");
    await expect(page.locator("#estop-key")).toHaveText("Esc, then space bar");
    expect((await operator.newest("tick")).state).toBe("idle");
    await page.keyboard.press("Escape");
    await page.keyboard.press("Space");
    await expect(page.locator("#sentence")).toHaveText("At rest: emergency stop");
    await page.locator("#reset").click();
  });

  test("stops while every other request hangs", async ({ page, walk }) => {
    const proxy = new HangingProxy();
    await proxy.begin(walk.port);
    let best_ms = Infinity;
    for (let attempt = 0; attempt < 3 && best_ms > 100; ++attempt) {
      const operator = await Operator.open(page, walk, proxy.address);
      if (attempt === 0) await operator.signedIn();
      await operator.follow();
      proxy.hangs = true;
      // More than the browser has connections.
      await page.evaluate(() => {
        for (let i = 0; i < 10; ++i) window.heel.bus.emit("live", true);
      });
      await expect.poll(() => proxy.hanging).toBeGreaterThan(0);
      best_ms = Math.min(best_ms, await operator.zeroAfter_ms(() => page.locator("#estop").click()));
      await expect(page.locator("#banner")).toContainText("Connection lost");
      await expect(page.locator("#banner")).not.toContainText("not confirmed");
      proxy.hangs = false;
    }
    proxy.end();
    console.log(`zero on the wire while all else hangs: ${best_ms.toFixed(0)} ms`);
    expect(best_ms).toBeLessThan(100);
    const operator = await Operator.open(page, walk, walk.address);
    await operator.signedIn();
    await page.locator("#reset").click();
  });

  test("says so when an emergency stop is not confirmed", async ({ operator, page }) => {
    await operator.signedIn();
    await page.route("**/estop", () => {});
    await page.evaluate(() => (window.heel.channel.tellEmergencyStop = () => {}));
    await page.locator("#estop").click();
    await expect(page.locator("#banner")).toContainText("not confirmed: use the robot's STOP button");
    await page.unroute("**/estop");
    await expect(page.locator("#banner")).toBeHidden();
    await expect(page.locator("#sentence")).toHaveText("At rest: emergency stop");
    await page.locator("#reset").click();
  });
});

test.describe("phone", () => {
  test.use({ viewport: kPhone, hasTouch: true, isMobile: true, deviceScaleFactor: 2 });

  test("has state and emergency stop on the screen in each view, and stops by a finger", async ({ operator, page }) => {
    await operator.signedIn();
    await operator.follow();
    await expect.poll(async () => (await pictureContent(page)).yellow).toBeGreaterThan(200);
    await page.waitForTimeout(1500);
    await operator.screenshot("phone", screenshots());
    for (const tab of ["plots", "settings", "log", "live"]) {
      await page.locator(`#tab-${tab}`).tap();
      await expect(page.locator(`#panel-${tab}`)).toBeInViewport();
      for (const id of ["#sentence", "#estop", "#stop"]) await expect(page.locator(id)).toBeInViewport({ ratio: 1 });
      const width = await page.evaluate(() => document.documentElement.scrollWidth);
      expect(width).toBe(kPhone.width);
    }
    await expectAccessible(page);
    const stopped_ms = await operator.stoppedAfter_ms(() => page.locator("#estop").tap());
    console.log(`zero on the wire after a finger: ${stopped_ms.toFixed(0)} ms`);
    expect(stopped_ms).toBeLessThan(100);
    await page.locator("#reset").tap();
    await expect(page.locator("#sentence")).toHaveText("At rest: not started");
  });
});

test.describe("desktop, at rest", () => {
  test.use({ viewport: kDesktop });

  test("sets a gain, shows the difference, takes it back and saves it", async ({ operator, page, walk }) => {
    await operator.signedIn();
    await page.locator("#tab-settings").click();
    await page.locator("#setting-search").fill("gain_yaw");
    const row = page.locator("[data-key='control.gain_yaw_1_s']");
    const gain = page.getByLabel("control.gain_yaw_1_s", { exact: true });
    await expect(page.locator("[data-key='gate.v_max_m_s']")).toBeHidden();
    await gain.fill("11");
    await page.keyboard.press("Enter");
    await expect(row.getByRole("alert")).toContainText("expected 0 … 10 1/s");
    await gain.fill("0.6");
    await page.keyboard.press("Enter");
    await expect(row.locator(".setting-marks")).toContainText("file 0.82");
    await expect(row.getByRole("alert")).toBeEmpty();
    await expect(page.locator("#setting-changes")).toHaveText("Not saved: control.gain_yaw_1_s 0.82 → 0.6");
    await page.locator("#setting-undo").click();
    await expect(gain).toHaveValue("0.82");
    await expect(page.locator("#setting-changes")).toContainText("All as in");
    // The daemon's own refusal stands at the key.
    await page.locator("#setting-search").fill("gate.v_max");
    await page.getByLabel("gate.v_max_m_s", { exact: true }).fill("0.72");
    await page.keyboard.press("Enter");
    await expect(page.locator("[data-key='gate.v_max_m_s']").getByRole("alert")).toContainText("a limit is only made tighter");
    await page.locator("#setting-search").fill("");
    await gain.fill("0.7");
    await page.keyboard.press("Enter");
    await expect(page.locator("#setting-save")).toHaveText("Save 1 to file");
    await operator.screenshot("settings", screenshots());
    await page.locator("#setting-save").click();
    await expect(page.locator("#setting-note")).toContainText("Saved 1");
    expect(walk.savedConfig()).toContain("# This comment stays when the value below is saved.\ngain_yaw_1_s = 0.7\n");
    await expect(row).toHaveAttribute("data-changed", "false");
  });

  test("shows, filters and searches the log", async ({ operator, page }) => {
    await operator.signedIn();
    await page.locator("#tab-log").click();
    const lines = page.locator("#log-lines .log-line:visible");
    await expect(lines.filter({ hasText: "gain_yaw_1_s" }).first()).toBeVisible();
    await page.getByRole("radio", { name: "Warnings" }).click();
    await expect(page.locator("#log-lines [data-severity='info']:visible")).toHaveCount(0);
    await page.getByRole("radio", { name: "All", exact: true }).last().click();
    await page.locator("#log-search").fill("gain_yaw_1_s");
    await expect(lines.filter({ hasNotText: "gain_yaw_1_s" })).toHaveCount(0);
  });

  test("knows an advice for every reason to rest", async ({ operator, page }) => {
    const names = readFileSync(new URL("../../src/core/flow_names.cpp", import.meta.url), "utf8");
    const reasons = [...names.matchAll(/case StopReason::\w+:\s+return "([^"]+)"/g)].map(([, text]) => text);
    expect(reasons.length).toBeGreaterThan(15);
    const known = await page.evaluate(async () => Object.keys((await import("/sentence.js")).kAdvice));
    expect(known.sort()).toEqual(reasons.sort());
    expect(operator).toBeTruthy();
  });

  test("has room for the longest sentence at every size", async ({ operator, page }) => {
    await operator.signedIn();
    for (const [width, height] of [[1440, 900], [1180, 760], [820, 1180], [390, 844], [844, 390]]) {
      await page.setViewportSize({ width, height });
      // Measured at once, before the next news.
      const places = await page.evaluate(() => {
        const { bus } = window.heel;
        const config = bus.newest("config");
        bus.emit("config", { ...config, keys: config.keys.map((one) => (one.key === "supervisor.operator_timeout_s" ? { ...one, value: 2 } : one)) });
        const reason = "turning towards the person makes their bearing grow";
        bus.emit("tick", { ...bus.newest("tick"), state: "stopped", reason, sentence: `at rest: ${reason}; then \`heel reset\`` });
        const places = ["sentence", "advice", "estop", "start", "stop", "reset", "alive"].map((id) => {
          const { left, top, right, bottom } = document.getElementById(id).getBoundingClientRect();
          return { id, left, top, right, bottom };
        });
        bus.emit("config", config);
        return places;
      });
      for (const { id, left, top, right, bottom } of places) {
        const name = `${id} at ${width} x ${height}`;
        expect(right - left, name).toBeGreaterThan(id === "sentence" ? Math.min(320, width - 60) : 60);
        expect(left, name).toBeGreaterThanOrEqual(0);
        expect(top, name).toBeGreaterThanOrEqual(0);
        expect(right, name).toBeLessThanOrEqual(width);
        expect(bottom, name).toBeLessThanOrEqual(height);
      }
    }
  });

  test("has a name for every control, and enough contrast in light and dark", async ({ operator, page }) => {
    await operator.signedIn();
    // A few rows of each kind are enough: axe-core needs a tenth of a second for each.
    await page.locator("#tab-settings").click();
    await page.locator("#setting-filter").getByRole("radio", { name: "All" }).click();
    await page.locator("#setting-search").fill("supervisor.s");
    for (const tab of ["plots", "log", "settings"]) {
      await page.locator(`#tab-${tab}`).click();
      await expectAccessible(page);
    }
    await expect(page.locator(".setting:visible")).not.toHaveCount(0);
    await page.emulateMedia({ colorScheme: "dark" });
    await expectAccessible(page, { runOnly: ["color-contrast"] });
    await page.locator("#help").click();
    await expect(page.locator("#estop")).toBeInViewport();
    await page.locator("#keys").getByRole("button", { name: "Close" }).click();
    await expect(page.locator("#help")).toBeFocused();
  });
});

test.describe("without heeld", () => {
  test.use({ viewport: kDesktop, losesConnection: true });

  test("says that the connection is lost, marks the picture as old, and comes back by itself", async ({ operator, page, walk }) => {
    await operator.signedIn();
    await expect(page.locator("#sentence")).toHaveText("At rest: not started");
    await walk.end("heeld", "SIGKILL");
    await expect(page.locator("#banner")).toContainText("Connection lost");
    await expect(page.locator("#banner")).toContainText(/Last news \d+\.\d s ago/);
    await expect(page.locator("#control-note")).toContainText("Start, stop and reset: there is no connection to heeld");
    await expect(page.locator("#sentence")).toHaveText("No news from the robot");
    await expect(page.locator("#picture-stale")).toContainText("old");
    expect((await page.locator("#banner").boundingBox()).width).toBe(kDesktop.width);
    await operator.screenshot("lost", screenshots());
    await walk.startDaemon();
    await expect(page.locator("#banner")).toBeHidden();
    await expect(page.locator("#picture-stale")).toBeHidden();
    await expect(page.locator("#session")).toHaveText("Sign out");
    await expect(page.locator("#sentence")).toHaveText("At rest: not started");
  });
});
