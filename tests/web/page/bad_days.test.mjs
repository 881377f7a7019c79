// SPDX-License-Identifier: MIT
// What goes wrong around a page: each has a calm and right behaviour.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { until } from "../server/robot.mjs";
import { chip, ready, speed, Stage, stands, turns } from "./browser.mjs";

const its = new Stage();

describe("a page", () => {
  it("on a phone whose clock is wrong shows true ages", async () => {
    const page = await its.open("phone", {
      prepare: (page) =>
        page.addInitScript(() => {
          const now = Date.now;
          Date.now = () => now() - 400 * 86400e3;
        }),
    });
    await ready(page, its.robot);
    for (const id of ["link", "video"]) await until(async () => /^\d{1,3} ms$/.test((await chip(page, id).innerText()).trim()), `the age of ${id}`);
  });

  it("without storage works", async () => {
    const page = await its.open("laptop", {
      hash: "#map",
      prepare: (page) =>
        page.addInitScript(() => Object.defineProperty(window, "localStorage", { get: () => { throw new DOMException("denied", "SecurityError"); } })),
    });
    await ready(page, its.robot);
    await page.locator("canvas[data-tile]").first().waitFor();
    await page.getByRole("button", { name: "Layers" }).click();
    await page.getByLabel(/trail/i).click();
  });

  it("without workers draws its map all the same", async () => {
    const page = await its.open("laptop", { hash: "#map", prepare: (page) => page.addInitScript(() => delete window.Worker) });
    await ready(page, its.robot);
    await until(() => page.evaluate(() => [...document.querySelectorAll("canvas[data-tile]")].some((c) => c.width > 0)), "a tile");
  });

  it("whose worker cannot be had draws its map all the same", async () => {
    const page = await its.open("laptop", { hash: "#map", prepare: (page) => page.route(/map_worker/, (route) => route.fulfill({ status: 404 })) });
    await ready(page, its.robot);
    await until(() => page.evaluate(() => [...document.querySelectorAll("canvas[data-tile]")].some((c) => c.width > 0)), "a tile");
  });

  it("that falls asleep while driving lets go, and wakes up ready", async () => {
    const page = await its.open("laptop");
    await ready(page, its.robot);
    const session = await page.context().newCDPSession(page);
    await page.keyboard.down("KeyA");
    await turns(its.robot);
    await session.send("Debugger.enable");
    await session.send("Debugger.pause"); // nothing of the page runs any more
    await stands(its.robot);
    await new Promise((resolve) => setTimeout(resolve, 3000));
    await session.send("Debugger.resume");
    await page.keyboard.up("KeyA");
    await ready(page, its.robot);
    await page.keyboard.down("KeyA");
    await turns(its.robot);
    await page.keyboard.up("KeyA");
  });

  it("that is hidden lets go of the wheel, and takes it when it is looked at again", async () => {
    const page = await its.open("laptop", {
      prepare: (page) =>
        page.addInitScript(() => {
          window.away = false;
          Object.defineProperty(document, "hidden", { get: () => window.away });
          window.look = (away) => {
            window.away = away;
            document.dispatchEvent(new Event("visibilitychange"));
          };
        }),
    });
    await ready(page, its.robot);
    await page.keyboard.down("KeyA");
    await turns(its.robot);
    await page.evaluate(() => window.look(true));
    await stands(its.robot);
    await until(async () => (await its.robot.json("/api/v1/state")).driver === null, "the wheel to be free");
    await page.keyboard.up("KeyA");
    await page.evaluate(() => window.look(false));
    await ready(page, its.robot);
  });

  it("survives a robot that begins anew, and drives the new one", async () => {
    const page = await its.open("laptop");
    await ready(page, its.robot);
    const { port } = its.robot;
    await its.robot.stop("SIGKILL");
    await page.getByRole("alert").filter({ hasText: "Connection lost" }).waitFor();
    its.robot = await (await import("../server/robot.mjs")).Robot.start("--port", String(port));
    await ready(page, its.robot);
    await page.keyboard.down("KeyA");
    await turns(its.robot);
    await page.keyboard.up("KeyA");
    await stands(its.robot);
    assert.equal(await speed(its.robot), 0);
  });
});
