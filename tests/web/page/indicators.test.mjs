// SPDX-License-Identifier: MIT
// Each indicator of the thesis's client, and ours, is seen once: what the robot can be brought to say, it says; the
// rest comes from the robot's own messages, changed on their way.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { until } from "../server/robot.mjs";
import { chip, picture, ready, Stage } from "./browser.mjs";

const its = new Stage();
const pilot = { mode: "navigate", phase: "active", reason: "", goal: null, route: [], remaining_m: null, places: [], nearest: null };
const goal = { x_m: 1, y_m: 0.5, yaw_rad: 0 };

/** What is changed in the state, what indicator tells it, and in which words. */
const CASES = [
  [{ autopilot: pilot }, "autopilot", "good", /Autopilot/],
  [{ autopilot: { ...pilot, phase: "idle" } }, "autopilot", "plain", /Nothing to do/],
  [{ autopilot: { ...pilot, phase: "stopped", reason: "it touched something" } }, "autopilot", "bad", /stopped/],
  [{ autopilot: { ...pilot, goal, route: [[0, 0], [1, 0.5]], remaining_m: 1.1 } }, "navigation", "good", /On the way 1.1 m/],
  [{ autopilot: { ...pilot, phase: "idle" } }, "navigation", "plain", /No destination/],
  [{ autopilot: { ...pilot, goal, phase: "stopped" } }, "navigation", "warn", /No route/],
  [{ autopilot: { ...pilot, mode: "explore" } }, "exploration", "good", /Exploring/],
  [{}, "battery", "good", /%/],
  [{ battery: { voltage_v: 11.2, share: 0.2, level: "low", brownout: false } }, "battery", "warn", /20 %/],
  [{ battery: { voltage_v: 10.8, share: 0.05, level: "recharge", brownout: false } }, "battery", "bad", /Recharge/],
  [{ battery: { voltage_v: 9.6, share: 0.3, level: "good", brownout: true } }, "brownout", "bad", /Brownout/],
  [{ verdict: { motion: "slow", cause: "obstacle", reason: "obstacle 0.31 m ahead" } }, "near", "warn", /Close/],
  [{ collision: true }, "collision", "bad", /Collision/],
  [{ pose: { unsteady: "turning" } }, "yaw", "warn", /Turning/],
  [{ pose: { unsteady: "tilting" } }, "tilt", "warn", /Tilting/],
  [{ power: { left: 0.42, right: 0.3 } }, "power", "plain", /42 %/],
  [{ pose: { quality: 0.2 } }, "pose", "warn", /20 %/],
  [{ pose: { lost: true } }, "lost", "bad", /Lost/],
  [{ recording: { active: true, asked_for: true, file: "a.mcap", bytes: 9, messages: 9, seconds: 75, dropped: 0, trouble: "" } }, "recording", "bad", /1:15/],
  [{}, "wheel", "good", /You drive/],
  [{}, "link", "good", /ms|Linked/],
  [{}, "video", "good", /ms/],
];

const merged = (state, change) => ({ ...state, ...change, pose: { ...state.pose, ...change.pose } });

describe("the indicators", () => {
  it("each are shown once, and tell what they mean when they are touched", async () => {
    let change = {};
    const page = await its.open("phone", {
      prepare: (page) =>
        page.routeWebSocket(/\/ws\/state$/, (socket) => {
          const robot = socket.connectToServer();
          robot.onMessage((message) => socket.send(JSON.stringify(merged(JSON.parse(message), change))));
        }),
    });
    await ready(page, its.robot);
    for (const [what, id, level, words] of CASES) {
      change = what;
      const shown = page.locator(`[data-indicator="${id}"].chip-${level}`).filter({ hasText: words });
      await shown.waitFor({ timeout: 5000 }).catch(() => assert.fail(`${id} ${level} ${words} was not shown for ${JSON.stringify(what)}`));
      await shown.tap();
      await until(async () => (await page.locator(".indicator-about").innerText()).length > 10, `what ${id} means`);
      await chip(page, id).tap();
      await until(async () => (await page.locator(".indicator-about").innerText()) === "", "the words to go");
    }
    change = Object.assign({}, ...CASES.map(([what]) => what), { pose: { unsteady: "turning", lost: true } });
    await chip(page, "lost").waitFor();
    await picture(page, "indicators-phone");
  });

  it("tell of an obstacle that is really there", async () => {
    const page = await its.open();
    await ready(page, its.robot);
    await page.keyboard.down("KeyW");
    await chip(page, "near").waitFor();
    await page.keyboard.up("KeyW");
  });
});
