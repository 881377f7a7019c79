// SPDX-License-Identifier: MIT
// Each view at each size and in both colours: a picture to look at, and nothing serious that axe-core finds.
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { describe, it } from "node:test";
import { picture, ready, SIZES, Stage } from "./browser.mjs";

const its = new Stage();
const axe = createRequire(import.meta.url).resolve("axe-core/axe.min.js");
const VIEWS = ["drive", "map", "more", "more/health", "more/recordings", "more/maps", "more/people", "more/settings", "more/log", "more/about"];

/** What axe-core says of a page that hinders somebody seriously. */
async function hindrances(page) {
  await page.addScriptTag({ path: axe });
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  return violations
    .filter(({ impact }) => impact === "serious" || impact === "critical")
    .map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join(" ")}`);
}

/** Buttons and links that a thumb would miss. */
const small = (page) =>
  page.evaluate(() =>
    [...document.querySelectorAll("button, select, input:not([type=range], [type=checkbox]), summary")]
      .map((element) => [element, element.getBoundingClientRect()])
      .filter(([, box]) => box.width > 0 && (box.width < 43.5 || box.height < 43.5))
      .map(([element, box]) => `${element.outerHTML.slice(0, 80)} ${box.width} x ${box.height}`),
  );

for (const size of Object.keys(SIZES))
  for (const colorScheme of ["light", "dark"])
    describe(`${size}, ${colorScheme}`, () => {
      it("every view is there, for everybody", async () => {
        const page = await its.open(size, { colorScheme, bypassCSP: true });
        await ready(page, its.robot);
        for (const view of VIEWS) {
          await page.evaluate((hash) => (location.hash = hash), view);
          await page.waitForTimeout(1200); // for what the view asks the robot
          await picture(page, `${view.replace("/", "-")}-${size}-${colorScheme}`);
          assert.deepEqual(await hindrances(page), [], view);
          assert.deepEqual(await small(page), [], view);
          const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
          assert.ok(wide <= 0, `${view} is ${wide} px too wide`);
        }
      });
    });

describe("a phone that lies", () => {
  it("has everything in reach", async () => {
    const page = await its.open("phone", { viewport: { width: 844, height: 390 } });
    await ready(page, its.robot);
    for (const view of ["drive", "map"]) {
      await page.evaluate((hash) => (location.hash = hash), view);
      await page.waitForTimeout(1000);
      await picture(page, `${view}-lying`);
      assert.ok(await page.getByRole("button", { name: "STOP" }).isVisible());
    }
  });
});
