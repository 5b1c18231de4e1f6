// The page while somebody is followed: look, sign in, follow, stop; on a desktop and on a phone. The person walks on all the time, so that
// what needs them in view comes first.

import { HangingProxy } from "./hanging_proxy.mjs";
import { expectAccessible, kDesktop, kPhone, pictureContent, plotsFilled, screenshots, smallTargets } from "./page_checks.mjs";
import { expect, Operator, test } from "./page_fixture.mjs";
import { eventually } from "./walk.mjs";

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

  test("follows after Start, with the quadrilateral on the shirt", { tag: "@picture" }, async ({ operator, page, walk }) => {
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
    expect(at(0.5)).toBeLessThan(5 * (await operator.bound_ms()));
    await expect(page.getByLabel("Latency, capture to command")).not.toHaveText("–");
    await plotsFilled(page);
    await operator.screenshot("following", screenshots());
  });

  test("says why it rests and what to do, from the robot's STOP button to the next walk", { tag: "@picture" }, async ({ operator, page, walk }) => {
    await page.emulateMedia({ colorScheme: "dark" });
    await operator.signedIn();
    await operator.follow();
    await plotsFilled(page);
    walk.fault("stop_button+3");
    await expect(page.locator("#sentence")).toHaveText("At rest: stop button pressed");
    await expect(page.locator("#advice")).toHaveText("Release the STOP button on the robot, then press Reset, then Start.");
    await expect(page.locator("body")).toHaveAttribute("data-level", "bad");
    expect((await page.locator("#sentence").boundingBox()).height, "the sentence is in one line").toBeLessThan(50);
    await expect(page.locator("#figure-speed")).toHaveText("0.00 m/s");
    await operator.screenshot("rest", screenshots());
    await eventually(async () => !(await operator.newest("tick")).robot.stop_button, "the button is released");
    await page.locator("#reset").click();
    await expect(page.locator("#sentence")).toHaveText("At rest: not started");
    await operator.follow();
    await page.locator("#stop").click();
  });

  test("stops by the button and by the space bar within 100 ms, wherever the focus is", async ({ operator, page }) => {
    await operator.signedIn();
    const button_ms = await operator.stoppedAfter_ms(() => page.locator("#estop").click());
    await page.locator("#tab-settings").click();
    await page.getByLabel("control.gain_yaw_1_s", { exact: true }).focus();
    const space_ms = await operator.stoppedAfter_ms(() => page.keyboard.press("Space"));
    console.log(`zero on the wire after the button: ${button_ms.toFixed(0)} ms, after the space bar: ${space_ms.toFixed(0)} ms`);
    const bound_ms = await operator.bound_ms();
    expect(button_ms).toBeLessThan(bound_ms);
    expect(space_ms).toBeLessThan(bound_ms);
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
    let bound_ms = 100;
    for (let attempt = 0; attempt < 3 && best_ms > bound_ms; ++attempt) {
      const operator = await Operator.open(page, walk, proxy.address);
      if (attempt === 0) await operator.signedIn();
      await operator.follow();
      bound_ms = await operator.bound_ms();
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
    expect(best_ms).toBeLessThan(bound_ms);
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

  test("has state and emergency stop on the screen in each view, and stops by a finger", { tag: "@picture" }, async ({ operator, page }) => {
    await operator.signedIn();
    await operator.follow();
    await expect.poll(async () => (await pictureContent(page)).yellow).toBeGreaterThan(200);
    const [map, controls] = await Promise.all(["#map", ".controls"].map((id) => page.locator(id).boundingBox()));
    expect(map.y + map.height, "the whole map above the controls").toBeLessThanOrEqual(controls.y);
    await operator.screenshot("phone", screenshots());
    for (const tab of ["plots", "settings", "log", "live"]) {
      await page.locator(`#tab-${tab}`).tap();
      await expect(page.locator(`#panel-${tab}`)).toBeInViewport();
      for (const id of ["#sentence", "#estop", "#stop"]) await expect(page.locator(id)).toBeInViewport({ ratio: 1 });
      const width = await page.evaluate(() => document.documentElement.scrollWidth);
      expect(width).toBe(kPhone.width);
      expect(await smallTargets(page), tab).toEqual([]);
    }
    await expectAccessible(page);
    const stopped_ms = await operator.stoppedAfter_ms(() => page.locator("#estop").tap());
    console.log(`zero on the wire after a finger: ${stopped_ms.toFixed(0)} ms`);
    expect(stopped_ms).toBeLessThan(await operator.bound_ms());
    await expect(page.locator("#figure-speed")).toHaveText("0.00 m/s");
    await page.emulateMedia({ colorScheme: "dark" });
    await operator.screenshot("phone-emergency", screenshots());
    await page.locator("#reset").tap();
    await expect(page.locator("#sentence")).toHaveText("At rest: not started");
  });
});
