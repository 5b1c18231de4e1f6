// One heeld and one simulated walk for all tests, so they run one after another.
import { defineConfig } from "@playwright/test";

const chromium = process.env.HEEL_CHROMIUM ?? "/usr/bin/chromium";
const out = `${process.env.HEEL_BUILD_DIR ?? "../../build/release"}/page`;

export default defineConfig({
  testDir: ".",
  testMatch: "*.spec.mjs",
  outputDir: `${out}/failures`,
  workers: 1,
  fullyParallel: false,
  // Time-outs only end a test that fails: a busy machine makes these tests longer.
  timeout: 180_000,
  expect: { timeout: 60_000 },
  reporter: [["list"]],
  use: {
    browserName: "chromium",
    actionTimeout: 60_000,
    locale: "en-GB",
    launchOptions: { executablePath: chromium, args: ["--no-sandbox"] },
  },
  // Where pictures of the page go: tools/page-pictures has those written that the documents show.
  metadata: { screenshots: process.env.HEEL_PAGE_PICTURES ?? `${out}/screenshots` },
});
