// SPDX-License-Identifier: MIT
// What goes wrong around a page: each has a calm and right behaviour.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { deflateSync } from "node:zlib";
import { until } from "../server/robot.mjs";
import { chip, middle, picture, ready, speed, Stage, stands, turns } from "./browser.mjs";

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

describe("a map of 100 x 60 m", () => {
  const SIDE_M = 64 * 0.02;
  const [WIDE, HIGH] = [Math.ceil(100 / SIDE_M), Math.ceil(60 / SIDE_M)];

  /** A map message with the chunks from `first` on, walled off from each other, with a door in each wall. */
  function message(first, count, mapId) {
    const chunks = Buffer.alloc(4112 * count);
    for (let i = 0; i < count; i++) {
      const at = 4112 * i;
      chunks.writeInt16LE((first + i) % WIDE, at);
      chunks.writeInt16LE(Math.floor((first + i) / WIDE), at + 2);
      chunks.writeUInt32LE(1, at + 4);
      for (let cell = 0; cell < 4096; cell++) {
        const [x, y] = [cell % 64, cell >> 6];
        const isWall = (x < 3 || y < 3) && !(x > 20 && x < 40) && !(y > 20 && y < 40);
        chunks[at + 16 + cell] = isWall ? 0x87 : 0x40 | ((x * y * (first + i)) & 7);
      }
    }
    const head = Buffer.alloc(24);
    head.writeUInt8(2, 0);
    head.writeUInt8(first + count >= WIDE * HIGH ? 1 : 0, 1);
    head.writeUInt16LE(count, 2);
    head.writeFloatLE(0.02, 4);
    head.writeBigUInt64LE(mapId, 8);
    return Buffer.concat([head, deflateSync(chunks)]);
  }

  it("comes up on a phone without making it stutter", async () => {
    const page = await its.open("phone", {
      hash: "#map",
      prepare: async (page) => {
        await page.addInitScript(() => {
          window.long = [];
          new PerformanceObserver((list) => window.long.push(...list.getEntries().map((task) => Math.round(task.duration)))).observe({ type: "longtask", buffered: true });
        });
        await page.routeWebSocket(/\/ws\/map$/, (socket) =>
          socket.onMessage(async () => {
            for (let first = 0; first < WIDE * HIGH; first += 24) {
              socket.send(message(first, Math.min(24, WIDE * HIGH - first), 7n));
              await new Promise((resolve) => setTimeout(resolve, 10));
            }
          }),
        );
      },
    });
    await page.waitForFunction(() => window.dynslam?.robot.wheel.value.mine);
    for (let i = 0; i < 5; i++) {
      await page.getByRole("button", { name: "Farther" }).tap();
      await page.waitForTimeout(400);
    }
    await page.getByRole("button", { name: "Follow the robot" }).tap();
    const { x, y } = await middle(page.locator(".map"));
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x - 80, y + 120, { steps: 10 });
    await page.mouse.up();
    await until(
      () => page.evaluate(() => [...document.querySelectorAll("canvas[data-tile]")].some((c) => c.width > 0)),
      "the whole map",
      20000,
    );
    await page.waitForTimeout(3000);
    await picture(page, "map-100x60-phone");
    const session = await page.context().newCDPSession(page);
    const { usedSize } = await session.send("Runtime.getHeapUsage");
    const long = await page.evaluate(() => window.long);
    console.log(`a map of 100 x 60 m, ${WIDE * HIGH} chunks: heap ${(usedSize / 1e6).toFixed(1)} MB, tasks over 50 ms: ${long.join(" ") || "none"}`);
    assert.ok(usedSize < 60e6, "what the page's own thread holds of it is little");
    // One at the page's start, on a machine that is busy with more.
    assert.ok(long.filter((ms) => ms > 150).length <= 1, `tasks of ${long.join(", ")} ms`);
  });
});
