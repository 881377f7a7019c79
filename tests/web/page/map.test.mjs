// SPDX-License-Identifier: MIT
// The map on the page is the map that the robot has, it grows, and one can point at it.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { until } from "../server/robot.mjs";
import { Finger, middle, picture, ready, Stage } from "./browser.mjs";

const its = new Stage();
const FREE = 254;
const OCCUPIED = 0;
const TILE = 256;

/** The robot's map as others get it: `at(x, y)` of a cell of the frame `map`. */
async function mapFile() {
  const yaml = await (await its.robot.fetch("/api/v1/map.yaml")).text();
  const bytes = Buffer.from(await (await its.robot.fetch("/api/v1/map.pgm")).arrayBuffer());
  const [head, width, height] = /^P5\s+(?:#.*\s+)*(\d+)\s+(\d+)\s+255\s/.exec(bytes.toString("latin1", 0, 200));
  const cell = Number(/resolution: (\S+)/.exec(yaml)[1]);
  const [x0, y0] = /origin: \[(\S+), (\S+),/.exec(yaml).slice(1).map((v) => Math.round(Number(v) / cell));
  return {
    known: bytes.subarray(head.length).filter((v) => v === FREE || v === OCCUPIED).length,
    at: (x, y) => (x < x0 || y < y0 || x >= x0 + +width || y >= y0 + +height ? 205 : bytes[head.length + (+height - 1 - (y - y0)) * width + (x - x0)]),
  };
}

/** The tiles on the page at full resolution, as [tile x, tile y, brightness and opacity a pixel]. */
const tilesOf = (page) =>
  page.evaluate(() =>
    [...document.querySelectorAll("canvas[data-tile^='0/']")].filter((canvas) => canvas.width > 0).map((canvas) => {
      const [, x, y] = canvas.dataset.tile.split("/").map(Number);
      const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
      const seen = [];
      for (let i = 0; i < pixels.length; i += 4) seen.push(pixels[i + 3] < 128 ? -1 : pixels[i + 1]);
      return [x, y, seen];
    }),
  );

/** How many cells the page shows as the file has them, and how many not. */
async function compare(page) {
  const file = await mapFile();
  let same = 0;
  let other = 0;
  let shown = 0;
  for (const [tx, ty, seen] of await tilesOf(page))
    seen.forEach((brightness, i) => {
      const value = file.at(tx * TILE + (i % TILE), ty * TILE + (TILE - 1 - Math.floor(i / TILE)));
      const kind = brightness < 0 ? 205 : brightness > 128 ? FREE : OCCUPIED;
      if (kind !== 205) shown++;
      if (kind !== 205 || value !== 205) kind === value ? same++ : other++;
    });
  return { same, other, shown, known: file.known };
}

async function openMap(size, options) {
  const page = await its.open(size, { hash: "#map", ...options });
  await page.locator("canvas[data-tile]").first().waitFor();
  return page;
}

describe("the map", () => {
  it("is cell for cell the robot's", async () => {
    const page = await openMap("laptop");
    await ready(page, its.robot);
    await page.getByRole("button", { name: "Closer" }).click();
    // What is looked at changes while it is compared; it settles when the robot stands.
    const got = await until(async () => {
      const now = await compare(page);
      return now.shown > 20000 && now.other < 0.01 * now.same && now;
    }, "the page's map to be the robot's", 20000);
    console.log(`map on the page: ${got.same} cells as in map.pgm, ${got.other} not`);
  });

  it("grows while the robot drives", async () => {
    const page = await openMap("laptop");
    await ready(page, its.robot);
    const before = (await mapFile()).known;
    const shownBefore = await page.evaluate(() => document.querySelectorAll("canvas[data-tile]").length);
    assert.ok(shownBefore > 0);
    await page.keyboard.down("KeyW");
    await page.waitForTimeout(1500);
    await page.keyboard.up("KeyW");
    await page.keyboard.down("KeyA");
    await page.waitForTimeout(2500);
    await page.keyboard.up("KeyA");
    const after = (await mapFile()).known;
    assert.ok(after > 1.05 * before, `${before} cells before, ${after} after`);
    await page.getByRole("button", { name: "Closer" }).click();
    await until(async () => {
      const now = await compare(page);
      return now.other < 0.02 * now.same;
    }, "the page to have what was added", 20000);
    await picture(page, "map-driven-laptop");
  });

  it("is all there again after the network was away", async () => {
    const page = await openMap("phone");
    await ready(page, its.robot);
    await its.robot.stop();
    await page.getByRole("alert").filter({ hasText: "Connection lost" }).waitFor();
    its.robot = await (await import("../server/robot.mjs")).Robot.start("--port", String(its.robot.port));
    await page.getByRole("alert").waitFor({ state: "detached" });
    await page.getByRole("button", { name: "Closer" }).tap();
    await until(async () => (await compare(page)).shown > 10000, "the new robot's map");
    await until(async () => {
      const now = await compare(page);
      return now.other < 0.01 * now.same;
    }, "nothing of the old map to be left", 20000);
  });
});

describe("a destination", () => {
  it("is set by a long press, and sent when that is meant", async () => {
    const asked = [];
    const page = await openMap("phone", {
      prepare: (page) =>
        page.on("request", (request) => request.url().endsWith("/api/v1/goal") && asked.push(JSON.parse(request.postData()))),
    });
    await ready(page, its.robot);
    const finger = await Finger.of(page);
    const place = await middle(page.locator(".map"));
    await finger.down(place.x + 20, place.y);
    await page.waitForTimeout(700);
    await finger.up();
    await page.getByRole("button", { name: "Drive there" }).waitFor();
    assert.equal(asked.length, 0, "nothing drives before one says so");
    await picture(page, "goal-phone");
    await page.getByRole("button", { name: "Drive there" }).tap();
    await until(() => asked.length === 1, "the request");
    const { pose } = await its.robot.json("/api/v1/state");
    const away = Math.hypot(asked[0].x_m - pose.x_m, asked[0].y_m - pose.y_m);
    assert.ok(away > 0.1 && away < 3, `the place is where one pressed, ${away} m from the robot`);
    assert.ok(asked[0].x_m > pose.x_m, "right on the screen is east");
  });
});

describe("the tools", () => {
  it("measure", async () => {
    const page = await openMap("laptop");
    await ready(page, its.robot);
    await page.getByRole("button", { name: "Measure" }).click();
    const { x, y } = await middle(page.locator(".map"));
    await page.mouse.click(x - 100, y);
    await page.mouse.click(x + 100, y);
    const total = await until(async () => /(\d+\.\d+) m/.exec(await page.locator(".map-foot").innerText())?.[1], "a distance");
    // At the first zoom, on a screen as large, a cell of 2 cm is a pixel.
    assert.ok(Math.abs(Number(total) - 200 * 0.02) < 0.05, total);
    await picture(page, "measure-laptop");
  });

  it("save a picture", async () => {
    const page = await openMap("laptop");
    await ready(page, its.robot);
    const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: /Save/ }).click()]);
    assert.match(download.suggestedFilename(), /\.png$/);
  });
});
