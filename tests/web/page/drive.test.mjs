// SPDX-License-Identifier: MIT
// Whoever has the page has the robot in hand: by thumb, keys and gamepad; and whoever loses hold of it stops it.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { until } from "../server/robot.mjs";
import { chip, drives, Finger, middle, ready, speed, Stage, stands, turn, turns } from "./browser.mjs";
import { FlakyNetwork } from "./flaky_network.mjs";

const its = new Stage();

/** A gamepad that a test holds: `pad.buttons[7].value = 1`. */
function mockGamepad() {
  const button = () => ({ pressed: false, touched: false, value: 0 });
  window.rumbles = 0;
  window.pad = {
    id: "a gamepad", index: 0, connected: true, mapping: "standard", timestamp: 0,
    axes: [0, 0, 0, 0], buttons: Array.from({ length: 17 }, button),
    vibrationActuator: { playEffect: async () => { window.rumbles++; } },
  };
  navigator.getGamepads = () => [window.pad.connected ? window.pad : null];
  window.plug = () => window.dispatchEvent(new Event("gamepadconnected"));
}

describe("a thumb", () => {
  /** A page whose stick is pushed ahead, and where it was put down. */
  const pushed = async () => {
    const page = await its.open("phone");
    await ready(page, its.robot);
    const finger = await Finger.of(page);
    const { x, y } = await middle(page.locator(".joystick"));
    await finger.down(x, y);
    await finger.move(x, y - 30);
    await drives(its.robot);
    return { page, finger, x, y };
  };

  it("drives ahead, steers, and stops when it lifts", async () => {
    const { page, finger, x, y } = await pushed();
    assert.ok((await speed(its.robot)) > 0, "up is ahead");
    const drawn = await page.locator(".nipple .back").boundingBox();
    assert.ok(Math.hypot(drawn.x + drawn.width / 2 - x, drawn.y + drawn.height / 2 - y) < 5, "the stick is drawn under the thumb");
    await finger.move(x - 60, y);
    await until(async () => (await turn(its.robot)) > 0.1, "left on the stick to be left of the robot");
    await finger.up();
    await stands(its.robot);
    assert.equal(await page.locator(".nipple").count(), 0, "the stick goes with the thumb");
  });

  it("drives back", async () => {
    const { finger, x, y } = await pushed();
    await finger.move(x, y + 30);
    await until(async () => (await speed(its.robot)) < -0.05, "the robot to drive back");
    await finger.up();
    await stands(its.robot);
  });

  it("whose touch the system takes away lets go", async () => {
    const { finger } = await pushed();
    await finger.touch("touchCancel", []);
    await stands(its.robot);
  });

  it("lets go when the screen is turned", async () => {
    const { page, finger, x, y } = await pushed();
    await page.setViewportSize({ width: 844, height: 390 });
    await stands(its.robot);
    await finger.move(x, y - 45);
    await page.waitForTimeout(300);
    assert.equal(await speed(its.robot), 0, "a touch from before does not drive");
    await finger.up();
  });
});

describe("keys", () => {
  it("drive while they are down", async () => {
    const page = await its.open();
    await ready(page, its.robot);
    await page.keyboard.down("ArrowUp");
    await drives(its.robot);
    await page.keyboard.up("ArrowUp");
    await stands(its.robot);
    await page.keyboard.down("KeyD");
    await until(async () => (await turn(its.robot)) < -0.1, "D to turn right");
    await page.keyboard.up("KeyD");
    await stands(its.robot);
  });

  it("space stops until somebody clears it", async () => {
    const page = await its.open();
    await ready(page, its.robot);
    await page.keyboard.down("KeyA");
    await turns(its.robot);
    await page.keyboard.press("Space");
    await stands(its.robot);
    await page.keyboard.up("KeyA");
    await page.getByRole("button", { name: "Clear the stop" }).click();
    await ready(page, its.robot);
  });

  it("are let go when the window loses the focus, and do not come back by themselves", async () => {
    const page = await its.open();
    await ready(page, its.robot);
    await page.keyboard.down("KeyA");
    await turns(its.robot);
    await page.evaluate(() => window.dispatchEvent(new Event("blur")));
    await stands(its.robot);
    await page.waitForTimeout(300);
    assert.equal(await turn(its.robot), 0);
    await page.keyboard.up("KeyA");
  });

  it("scroll where one reads, and do not drive", async () => {
    const page = await its.open("laptop", { hash: "#more/about" });
    await ready(page, its.robot);
    await page.keyboard.down("ArrowDown");
    await page.waitForTimeout(400);
    assert.equal(await speed(its.robot), 0);
    await page.keyboard.up("ArrowDown");
  });

  it("stop when something else takes them, as a Mac's Cmd or a menu does", async () => {
    const page = await its.open();
    await ready(page, its.robot);
    for (const take of [() => page.keyboard.press("Meta"), () => page.mouse.click(400, 300, { button: "right" })]) {
      await page.keyboard.down("KeyA");
      await turns(its.robot);
      await take();
      await stands(its.robot);
      await page.keyboard.up("KeyA");
    }
  });

  it("set the power limit", async () => {
    const page = await its.open();
    await ready(page, its.robot);
    await page.keyboard.press("Minus");
    await until(async () => (await its.robot.json("/api/v1/state")).power_limit === 0.95, "the limit to fall");
    await page.keyboard.press("Equal");
    await until(async () => (await its.robot.json("/api/v1/state")).power_limit === 1, "the limit to rise");
  });
});

describe("a gamepad", () => {
  const open = async () => {
    const page = await its.open("laptop", { prepare: (page) => page.addInitScript(mockGamepad) });
    await ready(page, its.robot);
    await page.evaluate(() => window.plug());
    await page.waitForTimeout(100); // what is pushed when it is plugged in does not count
    return page;
  };
  const press = async (page, button) => {
    await page.evaluate((b) => (window.pad.buttons[b].pressed = true), button);
    await page.waitForTimeout(80);
    await page.evaluate((b) => (window.pad.buttons[b].pressed = false), button);
    await page.waitForTimeout(80);
  };

  it("drives with its triggers and steers with its stick", async () => {
    const page = await open();
    await page.evaluate(() => (window.pad.buttons[7].value = 0.5));
    await until(async () => (await speed(its.robot)) > 0.05, "the right trigger to drive ahead");
    await page.evaluate(() => void ([window.pad.buttons[7].value, window.pad.buttons[6].value] = [0, 0.5]));
    await until(async () => (await speed(its.robot)) < -0.05, "the left trigger to drive back");
    await page.evaluate(() => (window.pad.buttons[6].value = 0));
    await stands(its.robot);
    await page.evaluate(() => (window.pad.axes[0] = 0.6));
    await until(async () => (await turn(its.robot)) < -0.1, "the stick to the right to turn right");
    await page.evaluate(() => (window.pad.axes[0] = 0));
    await stands(its.robot);
  });

  it("that goes lets go", async () => {
    const page = await open();
    await page.evaluate(() => (window.pad.axes[0] = 0.6));
    await turns(its.robot);
    await page.evaluate(() => (window.pad.connected = false));
    await stands(its.robot);
  });

  it("switches the view, sets the power limit, sizes the minimap and stops", async () => {
    const page = await open();
    const limit = async () => (await its.robot.json("/api/v1/state")).power_limit;
    await press(page, 4);
    await until(async () => (await limit()) === 0.95, "less power");
    await press(page, 5);
    await until(async () => (await limit()) === 1, "more power");
    const before = await page.locator(".minimap").boundingBox();
    await press(page, 12);
    const after = await page.locator(".minimap").boundingBox();
    assert.ok(after.width > before.width, "the minimap grows");
    await press(page, 8);
    await page.locator('.app[data-view="map"]').waitFor();
    await press(page, 2);
    await until(async () => (await its.robot.json("/api/v1/state")).verdict.motion === "e-stop", "the stop");
    await page.getByRole("button", { name: "Clear the stop" }).click();
  });
});

describe("losing the page", () => {
  it("stops the robot when the network goes, says so, and comes back", async () => {
    const network = await FlakyNetwork.to(its.robot);
    const page = await its.open("laptop", { url: network.url });
    await ready(page, its.robot);
    await page.keyboard.down("KeyA");
    await turns(its.robot);
    network.die();
    await stands(its.robot);
    await page.getByRole("alert").filter({ hasText: "Connection lost" }).waitFor();
    network.live();
    await page.getByRole("alert").waitFor({ state: "detached" });
    await page.waitForTimeout(500);
    assert.equal(await turn(its.robot), 0, "a key that was held through it does not drive");
    await page.keyboard.up("KeyA");
    await ready(page, its.robot);
    await page.keyboard.down("KeyA");
    await turns(its.robot);
    await page.keyboard.up("KeyA");
    await network.end();
  });

  it("does not lose a STOP that was pressed meanwhile", async () => {
    const network = await FlakyNetwork.to(its.robot);
    const page = await its.open("laptop", { url: network.url });
    await ready(page, its.robot);
    network.die();
    await page.getByRole("button", { name: "STOP" }).click();
    await page.getByRole("alert").filter({ hasText: "has not heard" }).waitFor();
    assert.notEqual((await its.robot.json("/api/v1/state")).verdict.motion, "e-stop");
    network.live();
    await until(async () => (await its.robot.json("/api/v1/state")).verdict.motion === "e-stop", "the stop");
    await network.end();
  });

  it("does not obey late: commands that wait on the way are not for driving", async () => {
    const network = await FlakyNetwork.to(its.robot);
    const page = await its.open("laptop", { url: network.url });
    await ready(page, its.robot);
    await page.keyboard.down("KeyA");
    await turns(its.robot);
    network.slow(600);
    await stands(its.robot);
    await page.waitForTimeout(1500);
    assert.equal(await turn(its.robot), 0, "a key that is held is not obeyed 600 ms late");
    await page.keyboard.up("KeyA");
    await network.end();
  });

  it("stops the robot when the tab is closed", async () => {
    const page = await its.open();
    await ready(page, its.robot);
    await page.keyboard.down("KeyA");
    await turns(its.robot);
    await page.close();
    await stands(its.robot);
    await until(async () => (await its.robot.json("/api/v1/state")).driver === null, "the wheel to be free");
  });

  it("shows the delay of the link while driving", async () => {
    const page = await its.open();
    await ready(page, its.robot);
    await until(async () => /\d+ ms/.test(await chip(page, "link").innerText()), "the delay");
  });
});
