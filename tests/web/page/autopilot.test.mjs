// SPDX-License-Identifier: MIT
// Orders for the autopilot, and how it stands. The last part is for a robot that drives by itself:
// `node --test --test-name-pattern="really" page/autopilot.test.mjs` runs it alone.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { until } from "../server/robot.mjs";
import { drives, picture, ready, stands } from "./browser.mjs";
import { hindrances, small } from "./for_everybody.mjs";
import { button, MapStage, openPanel } from "./map_stage.mjs";

const its = new MapStage();
const PILOT = { mode: "navigate", phase: "active", reason: "", goal: null, route: [], remaining_m: null, places: [], nearest: null };

describe("orders", () => {
  it("go to the robot as they are pressed", async () => {
    const orders = [];
    const page = await its.openMap("laptop", { orders });
    await ready(page, its.robot);
    for (const [name, x_m] of [["Sofa", 1], ["Dock", -0.5], ["Attic", 0.5]]) await its.put(`places/${name}`, { x_m, y_m: 0.5 });
    await openPanel(page);
    for (const name of ["Explore", "Go home", "Stand by"]) await button(page, name).click();
    assert.ok(await page.locator(".pilot-orders").getByRole("button", { name: "By hand" }).getAttribute("aria-pressed"));
    await button(page, "Patrol …").click();
    for (const name of ["Sofa", "Attic", "Dock", "Attic"]) await page.getByRole("button", { name: new RegExp(`^${name}`) }).click();
    await picture(page, "patrol-laptop");
    await button(page, "Start the patrol").click();
    await until(() => orders.length === 4, "the orders");
    assert.deepEqual(orders, [["mode", { mode: "explore" }], ["mode", { mode: "home" }], ["mode", { mode: "navigate" }],
      ["mode", { mode: "patrol", places: ["Sofa", "Dock"] }]]);
    await button(page, "Places …").click();
    await page.getByRole("button", { name: "Drive there: Dock" }).click();
    await until(() => orders.length === 5, "the goal");
    assert.deepEqual(orders[4], ["goal", { name: "Dock", x_m: -0.5, y_m: 0.5 }]);
  });

  it("are for drivers; who watches sees how it stands", async () => {
    const autopilot = { ...PILOT, goal: { x_m: 1, y_m: 0.5, name: "Sofa" }, remaining_m: 3.2 };
    const page = await its.openMap("phone", {
      faked: () => ({ autopilot }),
      prepare: (page) => page.route(/\/api\/v1\/me$/, (route) => route.fulfill({ json: { name: "Vi", role: "viewer" } })),
    });
    await its.put("places/Sofa", { x_m: 1, y_m: 0.5 });
    await page.getByText("Driving to Sofa").waitFor();
    await page.getByText("3.2 m left").waitFor();
    await openPanel(page);
    for (const name of ["Explore", "Go home", "Patrol …", "Stand by", "By hand"]) assert.ok(await button(page, name).isDisabled(), name);
    await button(page, "Places …").click();
    await button(page, "Sofa").click();
    await page.getByRole("group", { name: "Sofa" }).waitFor();
    for (const name of ["Drive there", "Rename", "Delete: Sofa"]) assert.equal(await button(page, name).count(), 0, name);
    assert.equal(await button(page, "Draw a no-go area").count(), 0);
    assert.ok(await button(page, "STOP").isVisible());
  });
});

describe("how it stands", () => {
  const route = Array.from({ length: 20 }, (_, i) => [0.1 * i, 0.3 * Math.sin(0.3 * i)]);
  const goal = { x_m: 1.9, y_m: -0.2, name: "Sofa" };
  const places = [{ kind: "frontier", x_m: 1, y_m: 1 }, { kind: "unvisited", x_m: -1, y_m: 0.5 }, { kind: "old", x_m: 0.5, y_m: -0.6 }];
  const CASES = {
    driving: [{ ...PILOT, goal, route, remaining_m: 2.04 }, "Driving to Sofa", "2.0 m left"],
    waiting: [{ ...PILOT, goal, route, remaining_m: 1.2, reason: "somebody is in the way" }, "Driving to Sofa", "somebody is in the way"],
    exploring: [{ ...PILOT, mode: "explore", goal: { x_m: 1, y_m: 1 }, route: route.slice(0, 10), remaining_m: 0.9, places }, "Exploring", "0.9 m left"],
    idle: [{ ...PILOT, phase: "idle", reason: "it is at Sofa" }, "Nothing to do", "it is at Sofa"],
    "no-route": [{ ...PILOT, phase: "stopped", reason: "there is no way to Sofa", goal, nearest: [1, 0.4] }, "Stopped", "there is no way to Sofa"],
  };
  for (const [size, colorScheme] of [["phone", "light"], ["phone", "dark"], ["laptop", "light"]])
    it(`is said in words and drawn on the map, ${size}, ${colorScheme}`, async () => {
      let autopilot = null;
      const page = await its.openMap(size, { faked: () => ({ autopilot }), colorScheme, bypassCSP: true });
      await ready(page, its.robot);
      await its.put("places/Sofa", { x_m: 1.9, y_m: -0.2 });
      await its.put("places/Kitchen", { x_m: -0.8, y_m: 0.9 });
      await its.put("areas/Stairs", { corners: [[0.3, -1.6], [1.3, -1.6], [1.5, -0.9], [0.3, -0.8]] });
      await its.put("home", { x_m: 0, y_m: 0 });
      for (const [name, [pilot, ...words]] of Object.entries(CASES)) {
        autopilot = pilot;
        for (const text of words) await page.locator(".pilot").getByText(text).waitFor();
        if (name === "exploring") await openPanel(page);
        await page.waitForTimeout(300);
        await picture(page, `pilot-${name}-${size}-${colorScheme}`);
        assert.deepEqual(await hindrances(page), [], name);
        assert.deepEqual(await small(page), [], name);
      }
      await button(page, "Places …").click();
      await picture(page, `pilot-places-${size}-${colorScheme}`);
      assert.deepEqual(await hindrances(page), []);
      assert.deepEqual(await small(page), []);
      await button(page, "Kitchen").click();
      await page.getByRole("group", { name: "Kitchen" }).waitFor();
      await page.waitForTimeout(300);
      await picture(page, `place-picked-${size}-${colorScheme}`);
      assert.deepEqual(await hindrances(page), []);
      assert.deepEqual(await small(page), []);
    });
});

describe("a robot that really drives by itself", () => {
  const state = () => its.robot.json("/api/v1/state");
  const phase = (wanted, ms) => until(async () => {
    const { autopilot } = await state();
    return autopilot?.phase === wanted && autopilot;
  }, `the autopilot to be ${wanted}`, ms);

  /** A point a good metre off, with nothing near the way there. */
  async function openPlace() {
    const { pose, scan } = await state();
    const room = (degree) => Math.min(...Array.from({ length: 51 }, (_, i) => scan.ranges_cm[(degree + i - 25 + 360) % 360]).filter((cm) => cm > 0));
    const degree = Array.from({ length: 360 }, (_, d) => d).reduce((best, d) => (room(d) > room(best) ? d : best), 0);
    const off_m = Math.min(1.5, room(degree) / 100 - 0.6);
    assert.ok(off_m > 0.4, `there is room, ${off_m} m`);
    const angle = pose.yaw_rad + (degree * Math.PI) / 180;
    return { x: pose.x_m + off_m * Math.cos(angle), y: pose.y_m + off_m * Math.sin(angle) };
  }

  it("really comes to where one taps", async () => {
    let goal = null;
    const page = await its.openMap("laptop", {
      prepare: (page) => page.on("request", (request) => request.url().endsWith("/api/v1/goal") && (goal = request.postDataJSON())),
    });
    await ready(page, its.robot);
    const at = await its.screenOf(page);
    const place = at(await openPlace());
    await button(page, "Go there: tap a place").click();
    await page.mouse.click(place.x, place.y);
    await button(page, "Drive there").click();
    await phase("active", 10000);
    await page.locator(".pilot").getByText("m left").waitFor();
    await drives(its.robot);
    await picture(page, "really-driving-laptop");
    await phase("idle", 60000);
    const { pose } = await state();
    assert.ok(Math.hypot(pose.x_m - goal.x_m, pose.y_m - goal.y_m) < 0.3, JSON.stringify({ pose, goal }));
    await stands(its.robot);
  });

  it("really explores", async () => {
    const page = await its.openMap("phone");
    await ready(page, its.robot);
    const known = async () => {
      const bytes = Buffer.from(await (await its.robot.fetch("/api/v1/map.pgm")).arrayBuffer());
      return bytes.filter((value) => value === 254 || value === 0).length;
    };
    const before = await known();
    await openPanel(page);
    await button(page, "Explore").tap();
    const { mode } = await phase("active", 10000);
    assert.equal(mode, "explore");
    await page.locator(".pilot").getByText("Exploring").waitFor();
    await until(async () => (await known()) > 1.2 * before, "the map to grow", 90000);
    await picture(page, "really-exploring-phone");
  });

  it("really stops, and says so", async () => {
    const page = await its.openMap("phone");
    await ready(page, its.robot);
    await openPanel(page);
    await button(page, "Explore").tap();
    await phase("active", 10000);
    await drives(its.robot);
    await button(page, "STOP").tap();
    await stands(its.robot);
    const { reason } = await phase("stopped", 10000);
    assert.ok(reason.length > 3, reason);
    await page.locator(".pilot").getByText(reason).waitFor();
    await page.waitForTimeout(1000);
    await stands(its.robot);
  });

  it("really gives way to who steers", async () => {
    const page = await its.open("laptop");
    await ready(page, its.robot);
    await page.getByRole("button", { name: /^Autopilot/ }).click();
    await button(page, "Explore").click();
    await phase("active", 10000);
    await drives(its.robot);
    await page.waitForTimeout(1000);
    assert.equal((await state()).autopilot?.phase, "active", "that his page is open is no steering");
    await page.keyboard.down("KeyS");
    await until(async () => (await state()).autopilot === null, "the autopilot to be off");
    await page.keyboard.up("KeyS");
    await stands(its.robot);
  });
});
