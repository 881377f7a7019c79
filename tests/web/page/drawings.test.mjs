// SPDX-License-Identifier: MIT
// What people draw on the map: no-go areas, places with a name, home.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { until } from "../server/robot.mjs";
import { Finger, middle, picture, ready } from "./browser.mjs";
import { hindrances } from "./for_everybody.mjs";
import { button, MapStage, openPanel } from "./map_stage.mjs";

const its = new MapStage();

describe("a no-go area", () => {
  it("is drawn corner by corner, kept under a name, and deleted by tapping it", async () => {
    const page = await its.openMap("phone");
    await ready(page, its.robot);
    const at = await its.screenOf(page);
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
    const { areas } = await until(async () => (await its.notes()).areas.length === 1 && its.notes(), "the area");
    assert.equal(areas[0].name, "Stairs");
    assert.equal(areas[0].corners.length, 4);
    areas[0].corners.flat().forEach((value, i) => assert.ok(Math.abs(value - [0.5, 0.5, 1.5, 0.5, 1.5, 1.5, 0.5, 1.5][i]) < 0.1, JSON.stringify(areas)));

    await page.waitForTimeout(300);
    await tap(1.3, 1.3);
    await page.getByRole("group", { name: "Stairs" }).waitFor();
    await picture(page, "no-go-picked-phone");
    await page.getByRole("button", { name: "Delete: Stairs" }).tap();
    await button(page, "Delete").tap();
    await until(async () => (await its.notes()).areas.length === 0, "the area to be gone");
    await page.getByText("Stairs is deleted.").waitFor();
    await picture(page, "no-go-deleted-phone");
    await button(page, "Undo").tap();
    await until(async () => (await its.notes()).areas.length === 1, "the area to be back");
    assert.deepEqual((await its.notes()).areas, areas);
    await page.getByText("Stairs is deleted.").waitFor({ state: "detached" });
  });

  it("takes no other's name, and so no other's place", async () => {
    const page = await its.openMap("phone", { bypassCSP: true });
    await ready(page, its.robot);
    const old = { corners: [[0.3, -1.6], [1.3, -1.6], [1.5, -0.9]] };
    await its.put("areas/Stairs", old);
    const at = await its.screenOf(page);
    await button(page, "Draw a no-go area").tap();
    for (const [x, y] of [[0.5, 0.5], [1.5, 0.5], [1.5, 1.5]]) {
      const place = at({ x, y });
      await page.touchscreen.tap(place.x, place.y);
    }
    await button(page, "Close the area").tap();
    const name = page.getByLabel("Name of the no-go area");
    await name.fill("Stairs");
    await page.getByText("There is one of this name already.").waitFor();
    assert.ok(await button(page, "Save").isDisabled());
    await name.fill("a/b");
    await page.getByText("At most 40 characters").waitFor();
    await picture(page, "no-go-name-phone");
    assert.deepEqual(await hindrances(page), []);
    // Somebody else is quicker.
    await name.fill("Cellar");
    await page.route(/\/api\/v1\/notes$/, (route) => route.abort());
    await its.put("areas/Cellar", old);
    await button(page, "Save").tap();
    await page.getByText("choose another name").waitFor();
    assert.deepEqual((await its.notes()).areas, [{ name: "Cellar", ...old }, { name: "Stairs", ...old }]);
  });

  it("that somebody else draws is seen, and what was set aside is told until it is read", async () => {
    let told = true;
    const page = await its.openMap("laptop", {
      prepare: (page) =>
        page.route(/\/api\/v1\/notes(\/notice)?$/, async (route) => {
          if (route.request().method() === "DELETE") told = false;
          if (route.request().method() !== "GET") return route.continue();
          return route.fulfill({ json: { ...(await its.notes()), notice: told ? "The robot began a new map." : "" } });
        }),
    });
    await ready(page, its.robot);
    await its.put("areas/Pond", { corners: [[0.4, 0.4], [1.4, 0.4], [1.4, 1.4]] });
    const at = await its.screenOf(page);
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

describe("a phone that lies", () => {
  it("shows what was tapped instead of the orders, for which there is no room beside it", async () => {
    const page = await its.openMap("phone", { viewport: { width: 844, height: 390 } });
    await ready(page, its.robot);
    await its.put("places/Sofa", { x_m: 2.4, y_m: 0.2 });
    const at = await its.screenOf(page);
    await openPanel(page);
    await button(page, "Explore").waitFor();
    await picture(page, "orders-lying");
    const place = at({ x: 2.4, y: 0.2 });
    await page.touchscreen.tap(place.x, place.y);
    await page.getByRole("group", { name: "Sofa" }).waitFor();
    await picture(page, "place-lying");
    assert.ok(await button(page, "Explore").isHidden());
    const { y } = await page.locator(".map-foot > :first-child").boundingBox();
    assert.ok(y >= 0, `${y}`);
  });
});

describe("what people drew", () => {
  it("is asked for again when there was no answer, and a late answer is not believed", async () => {
    let late = null;
    let asked = 0;
    const page = await its.openMap("laptop", {
      prepare: (page) =>
        page.route(/\/api\/v1\/notes$/, async (route) => {
          if (++asked === 1) return route.abort();
          if (asked !== 3) return route.continue();
          const before = await its.notes();
          late = () => route.fulfill({ json: before });
        }),
    });
    await ready(page, its.robot);
    await until(() => asked === 2, "the second question");
    await its.put("places/Sofa", { x_m: 1, y_m: 0.5 });
    await until(() => late, "the third question");
    await its.put("places/Dock", { x_m: 0.5, y_m: 0.5 });
    await openPanel(page);
    await button(page, "Places …").click();
    await button(page, "Dock").waitFor();
    await late();
    await page.waitForTimeout(300);
    assert.ok(await button(page, "Dock").isVisible());
  });

  it("can be found on the map by its name, and home too when its place is deleted", async () => {
    const page = await its.openMap("phone");
    await ready(page, its.robot);
    const dock = { x_m: 30, y_m: 20 };
    await its.put("places/Dock", dock);
    await its.put("home", { ...dock, name: "Dock" });
    await openPanel(page);
    await button(page, "Places …").tap();
    await button(page, "Dock").tap();
    await page.waitForTimeout(600);
    const centre = await middle(page.locator(".map"));
    await button(page, "Close").tap();
    await page.touchscreen.tap(centre.x, centre.y);
    await button(page, "Not home any more").waitFor();
    await page.getByRole("button", { name: "Delete: Dock" }).tap();
    await button(page, "Delete").tap();
    await page.getByText("Dock is deleted.").waitFor();
    await page.touchscreen.tap(centre.x, centre.y);
    await page.getByRole("group", { name: "Home" }).waitFor();
    await picture(page, "home-picked-phone");
    await button(page, "Not home any more").tap();
    await until(async () => (await its.notes()).home === null, "no home");
  });
});

describe("a place", () => {
  it("is saved where one presses long, and can be renamed, made home and deleted", async () => {
    const orders = [];
    const page = await its.openMap("phone", { orders });
    await ready(page, its.robot);
    const at = await its.screenOf(page);
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
    const { places, home } = await until(async () => (await its.notes()).home && its.notes(), "a home");
    assert.deepEqual(home, places[0]);
    assert.equal(places[0].name, "Küche");
    assert.ok(Math.hypot(places[0].x_m - 0.8, places[0].y_m - 0.6) < 0.1, JSON.stringify(places));
    await button(page, "Drive there").tap();
    await group("Küche").waitFor({ state: "detached" });
    assert.deepEqual(orders, [["goal", places[0]]]);
    await page.touchscreen.tap(there.x, there.y);
    await page.getByRole("button", { name: "Delete: Küche" }).tap();
    await button(page, "Delete").tap();
    await until(async () => (await its.notes()).places.length === 0, "the place to be gone");
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
    const [place] = (await its.notes()).places;
    const { pose } = await its.robot.json("/api/v1/state");
    assert.ok(Math.hypot(place.x_m - pose.x_m, place.y_m - pose.y_m) < 0.05);
    assert.equal(typeof place.yaw_rad, "number");
    assert.deepEqual(await thumb(), before);
  });
});
