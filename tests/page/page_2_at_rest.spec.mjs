// The page while the robot rests: settings, log, accessibility, and the loss of heeld. After page_1_walking.spec.mjs, with the same heeld.

import { readFileSync } from "node:fs";
import { expectAccessible, kDesktop, plotsFilled, screenshots } from "./page_checks.mjs";
import { expect, test } from "./page_fixture.mjs";

test.describe("desktop, at rest", () => {
  test.use({ viewport: kDesktop });

  test("sets a gain, shows the difference, takes it back and saves it", { tag: "@picture" }, async ({ operator, page, walk }) => {
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
    await expect(page.locator("#setting-note")).toHaveText("control.gain_yaw_1_s is 0.7");
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

  test("says that the connection is lost, marks the picture as old, and comes back by itself", { tag: "@picture" }, async ({ operator, page, walk }) => {
    await operator.signedIn();
    await expect(page.locator("#sentence")).toHaveText("At rest: not started");
    await plotsFilled(page);
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
