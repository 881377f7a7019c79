// SPDX-License-Identifier: MIT
// Orders for the autopilot, and what people draw on the map. The last part is for a robot that drives by itself:
// `node --test --test-name-pattern="really" page/autopilot.test.mjs` runs it alone.
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { describe, it } from "node:test";
import { until } from "../server/robot.mjs";
import { drives, Finger, middle, picture, ready, stands, Stage } from "./browser.mjs";

const its = new Stage();
const axe = createRequire(import.meta.url).resolve("axe-core/axe.min.js");
const PILOT = { mode: "navigate", phase: "active", reason: "", goal: null, route: [], remaining_m: null, places: [], nearest: null };

const notes = () => its.robot.json("/api/v1/notes");
const put = (path, body) => its.robot.fetch(`/api/v1/notes/${path}`, { method: "PUT", headers: { "content-type": "application/json" }, body: JSON.stringify(body) });
const button = (page, name) => page.getByRole("button", { name, exact: true });

/** The map at a size, around the robot; `faked`: what the robot's state is made to say, and orders are taken by nobody. */
async function openMap(size, { faked, orders, ...options } = {}) {
  const page = await its.open(size, {
    hash: "#map",
    ...options,
    prepare: async (page) => {
      await options.prepare?.(page);
      if (faked)
        await page.routeWebSocket(/\/ws\/state$/, (socket) => {
          const robot = socket.connectToServer();
          robot.onMessage((message) => socket.send(JSON.stringify({ ...JSON.parse(message), ...faked() })));
        });
      if (orders)
        await page.route(/\/api\/v1\/(mode|goal)$/, (route) => {
          orders.push([route.request().url().split("/").pop(), route.request().postDataJSON()]);
          return route.fulfill({ status: 204 });
        });
    },
  });
  await page.locator("canvas[data-tile]").first().waitFor();
  return page;
}

const openPanel = async (page) => (await page.locator(".pilot-head").getAttribute("aria-expanded")) === "true" || page.locator(".pilot-head").click();

async function pixelsPerMetre(page) {
  const bar = page.locator(".map-scale");
  const [, length, unit] = /([\d.]+) (c?m)/.exec(await bar.innerText());
  return (await bar.evaluate((e) => parseFloat(e.style.width))) / (Number(length) * (unit === "cm" ? 0.01 : 1));
}

/** Where a place of the map is on the screen, with the robot in its middle. */
async function screenOf(page) {
  await button(page, "Centre on the robot").click();
  await page.waitForTimeout(600);
  const scale = await pixelsPerMetre(page);
  const centre = await middle(page.locator(".map"));
  const { pose } = await its.robot.json("/api/v1/state");
  return ({ x, y }) => ({ x: centre.x + (x - pose.x_m) * scale, y: centre.y - (y - pose.y_m) * scale });
}

async function hindrances(page) {
  await page.addScriptTag({ path: axe });
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  return violations.filter(({ impact }) => impact === "serious" || impact === "critical").map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join(" ")}`);
}
const small = (page) =>
  page.evaluate(() =>
    [...document.querySelectorAll("button, input:not([type=range], [type=checkbox])")]
      .map((element) => [element, element.getBoundingClientRect()])
      .filter(([, box]) => box.width > 0 && (box.width < 43.5 || box.height < 43.5))
      .map(([element, box]) => `${element.outerHTML.slice(0, 80)} ${box.width} x ${box.height}`),
  );

describe("a no-go area", () => {
  it("is drawn corner by corner, kept under a name, and deleted by tapping it", async () => {
    const page = await openMap("phone");
    await ready(page, its.robot);
    const at = await screenOf(page);
    const tap = async (x, y) => {
      const place = at({ x, y });
      await page.touchscreen.tap(place.x, place.y);
    };
    await button(page, "Draw a no-go area").tap();
    for (const [x, y] of [[0.5, 0.5], [1.5, 0.5], [3, -0.4]]) await tap(x, y);
    await page.getByText("3 corners").waitFor();
    await button(page, "Undo").tap();
    for (const [x, y] of [[1.5, 1.5], [0.5, 1.5]]) await tap(x, y);
    await picture(page, "no-go-drawing-phone");
    await tap(0.5, 0.5); // the first one closes it
    await page.getByLabel("Name of the no-go area").fill("Stairs");
    await button(page, "Save").tap();
    const { areas } = await until(async () => (await notes()).areas.length === 1 && notes(), "the area");
    assert.equal(areas[0].name, "Stairs");
    assert.equal(areas[0].corners.length, 4);
    areas[0].corners.flat().forEach((value, i) => assert.ok(Math.abs(value - [0.5, 0.5, 1.5, 0.5, 1.5, 1.5, 0.5, 1.5][i]) < 0.1, JSON.stringify(areas)));

    await page.waitForTimeout(300);
    await tap(1.3, 1.3);
    await page.getByRole("group", { name: "Stairs" }).waitFor();
    await picture(page, "no-go-picked-phone");
    await page.getByRole("button", { name: "Delete: Stairs" }).tap();
    await button(page, "Delete").tap();
    await until(async () => (await notes()).areas.length === 0, "the area to be gone");
  });

  it("that somebody else draws is seen, and what was set aside is told until it is read", async () => {
    let told = true;
    const page = await openMap("laptop", {
      prepare: (page) =>
        page.route(/\/api\/v1\/notes(\/notice)?$/, async (route) => {
          if (route.request().method() === "DELETE") told = false;
          if (route.request().method() !== "GET") return route.continue();
          const answer = await route.fetch();
          return route.fulfill({ response: answer, json: { ...(await answer.json()), notice: told ? "The robot began a new map." : "" } });
        }),
    });
    await ready(page, its.robot);
    await put("areas/Pond", { corners: [[0.4, 0.4], [1.4, 0.4], [1.4, 1.4]] });
    const at = await screenOf(page);
    await page.waitForTimeout(500);
    const place = at({ x: 1.2, y: 0.7 });
    await page.mouse.click(place.x, place.y);
    await page.getByRole("group", { name: "Pond" }).waitFor();
    await page.getByText("The robot began a new map.").waitFor();
    await picture(page, "notes-notice-laptop");
    await button(page, "Understood").click();
    await page.getByText("The robot began a new map.").waitFor({ state: "detached" });
  });
});

describe("a place", () => {
  it("is saved where one presses long, and can be renamed, made home and deleted", async () => {
    const orders = [];
    const page = await openMap("phone", { orders });
    await ready(page, its.robot);
    const at = await screenOf(page);
    const there = at({ x: 0.8, y: 0.6 });
    const finger = await Finger.of(page);
    await finger.down(there.x, there.y);
    await page.waitForTimeout(700);
    await finger.up();
    await button(page, "Save as place").tap();
    await page.getByLabel("Name of the place").fill("Kitchen");
    await button(page, "Save").tap();
    const group = (name) => page.getByRole("group", { name });
    await group("Kitchen").waitFor();
    await picture(page, "place-phone");
    await button(page, "Rename").tap();
    await page.getByLabel("Rename").fill("Küche");
    await page.keyboard.press("Enter");
    await group("Küche").waitFor();
    await button(page, "Make it home").tap();
    const { places, home } = await until(async () => (await notes()).home && notes(), "a home");
    assert.deepEqual(home, places[0]);
    assert.equal(places[0].name, "Küche");
    assert.ok(Math.hypot(places[0].x_m - 0.8, places[0].y_m - 0.6) < 0.1, JSON.stringify(places));
    await button(page, "Drive there").tap();
    await group("Küche").waitFor({ state: "detached" });
    assert.deepEqual(orders, [["goal", places[0]]]);
    await page.touchscreen.tap(there.x, there.y);
    await page.getByRole("button", { name: "Delete: Küche" }).tap();
    await button(page, "Delete").tap();
    await until(async () => (await notes()).places.length === 0, "the place to be gone");
  });

  it("is saved where the robot is, while one drives", async () => {
    const page = await its.open("phone");
    await ready(page, its.robot);
    const thumb = () => page.locator(".joystick").boundingBox();
    const before = await thumb();
    await page.getByRole("button", { name: /^Autopilot/ }).tap();
    assert.deepEqual(await thumb(), before, "the thumb's place stays where it is");
    const panel = await page.locator(".drive-pilot .pilot").boundingBox();
    assert.ok(panel.y + panel.height <= before.y, "and free");
    await picture(page, "pilot-drive-phone");
    await button(page, "Places …").tap();
    await button(page, "Save where it is").tap();
    await page.getByLabel("Name of the place where the robot is").fill("Start");
    await button(page, "Save").tap();
    await button(page, "Start").waitFor();
    const [place] = (await notes()).places;
    const { pose } = await its.robot.json("/api/v1/state");
    assert.ok(Math.hypot(place.x_m - pose.x_m, place.y_m - pose.y_m) < 0.05);
    assert.equal(typeof place.yaw_rad, "number");
    assert.deepEqual(await thumb(), before);
  });
});

describe("orders", () => {
  it("go to the robot as they are pressed", async () => {
    const orders = [];
    const page = await openMap("laptop", { orders });
    await ready(page, its.robot);
    for (const [name, x_m] of [["Sofa", 1], ["Dock", -0.5], ["Attic", 0.5]]) await put(`places/${name}`, { x_m, y_m: 0.5 });
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
    const page = await openMap("phone", {
      faked: () => ({ autopilot }),
      prepare: (page) => page.route(/\/api\/v1\/me$/, (route) => route.fulfill({ json: { name: "Vi", role: "viewer" } })),
    });
    await put("places/Sofa", { x_m: 1, y_m: 0.5 });
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
      const page = await openMap(size, { faked: () => ({ autopilot }), colorScheme, bypassCSP: true });
      await ready(page, its.robot);
      await put("places/Sofa", { x_m: 1.9, y_m: -0.2 });
      await put("places/Kitchen", { x_m: -0.8, y_m: 0.9 });
      await put("areas/Stairs", { corners: [[0.3, -1.6], [1.3, -1.6], [1.5, -0.9], [0.3, -0.8]] });
      await put("home", { x_m: 0, y_m: 0 });
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
    const page = await openMap("laptop", {
      prepare: (page) => page.on("request", (request) => request.url().endsWith("/api/v1/goal") && (goal = request.postDataJSON())),
    });
    await ready(page, its.robot);
    const at = await screenOf(page);
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
    const page = await openMap("phone");
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
    const page = await openMap("phone");
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
