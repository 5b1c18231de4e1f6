// Checks and sizes that the tests of the page share.

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { expect, test } from "./page_fixture.mjs";

export const kDesktop = { width: 1440, height: 900 };
export const kPhone = { width: 390, height: 844 };
const kAxe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
export const screenshots = () => test.info().config.metadata.screenshots;

const kRules = { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"] };

/** Nothing that axe-core finds wrong, and no control without a name. */
export async function expectAccessible(page, rules = kRules) {
  // Not as an added script: the Content-Security-Policy allows none.
  await page.evaluate(kAxe);
  const result = await page.evaluate((which) => window.axe.run(document, which), rules);
  const found = result.violations.map(({ id, help, nodes }) => `${id}: ${help}: ${nodes.map((node) => node.html.slice(0, 120)).join(" | ")}`);
  expect(found).toEqual([]);
}

/** Seconds that the plots show in the documents' pictures; the tests do not wait for them. */
const kPlotted_s = 24;

/** Until the plots show as much as a picture of them needs, where the pictures are for the documents. */
export async function plotsFilled(page) {
  if (!process.env.HEEL_PAGE_PICTURES) return;
  await page.getByRole("radio", { name: "30 s" }).click();
  await page.waitForTimeout(kPlotted_s * 1000);
}

/** The controls in view that are too small for a thumb. */
export function smallTargets(page) {
  return page.evaluate(() => [...document.querySelectorAll("button, input, select")].filter((one) => one.checkVisibility())
    .map((one) => ({ name: one.id || one.textContent, box: one.getBoundingClientRect() }))
    .filter(({ box }) => box.width < 44 || box.height < 44)
    .map(({ name, box }) => `${name}: ${Math.round(box.width)} x ${Math.round(box.height)}`));
}

/** How many pixels of the picture are of the quadrilateral's colour, and how different the others are. */
export function pictureContent(page) {
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
