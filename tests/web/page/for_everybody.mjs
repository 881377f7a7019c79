// SPDX-License-Identifier: MIT
// What keeps somebody from using a page.
import { createRequire } from "node:module";

const axe = createRequire(import.meta.url).resolve("axe-core/axe.min.js");

/** What axe-core says of a page that hinders somebody seriously. */
export async function hindrances(page) {
  await page.addScriptTag({ path: axe });
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  return violations
    .filter(({ impact }) => impact === "serious" || impact === "critical")
    .map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join(" ")}`);
}

/** Buttons and fields that a thumb would miss. */
export const small = (page) =>
  page.evaluate(() =>
    [...document.querySelectorAll("button, select, input:not([type=range], [type=checkbox]), summary")]
      .map((element) => [element, element.getBoundingClientRect()])
      .filter(([, box]) => box.width > 0 && (box.width < 43.5 || box.height < 43.5))
      .map(([element, box]) => `${element.outerHTML.slice(0, 80)} ${box.width} x ${box.height}`),
  );
