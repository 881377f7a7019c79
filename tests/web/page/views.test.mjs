// SPDX-License-Identifier: MIT
// Each view at each size and in both colours: a picture to look at, and nothing serious that axe-core finds.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { picture, ready, SIZES, Stage } from "./browser.mjs";
import { hindrances, small } from "./for_everybody.mjs";

const its = new Stage();
const VIEWS = ["drive", "map", "more", "more/health", "more/recordings", "more/maps", "more/people", "more/settings", "more/log", "more/about"];

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
