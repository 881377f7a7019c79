// SPDX-License-Identifier: MIT
// Watching a robot that drives itself does not disturb it; steering does.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { until } from "../server/robot.mjs";
import { speed, Stage } from "./browser.mjs";

const its = new Stage("--mission", "tour");

describe("a robot on its tour", () => {
  it("goes on while somebody watches, and is his when he steers", async () => {
    const page = await its.open("laptop");
    await page.waitForFunction(() => window.dynslam?.robot.wheel.value.mine);
    await until(async () => Math.abs(await speed(its.robot)) > 0.1, "the robot to drive, though the page is open");
    await page.waitForTimeout(1000);
    const { distance, lost } = await page.evaluate(async () => {
      const { robot } = window.dynslam;
      const from = robot.state.value.pose;
      await new Promise((resolve) => setTimeout(resolve, 4000));
      const to = robot.state.value.pose;
      return { distance: Math.hypot(to.x_m - from.x_m, to.y_m - from.y_m) + Math.abs(to.yaw_rad - from.yaw_rad), lost: to.lost };
    });
    assert.ok(distance > 0.3 && !lost, `it came ${distance} far in 4 s`);
    await page.keyboard.down("KeyA");
    await until(async () => (await its.robot.json("/api/v1/state")).applied.w_radps > 1.5, "the robot to turn as it is told", 5000);
    await page.keyboard.up("KeyA");
    await until(async () => {
      const { left, right } = (await its.robot.json("/api/v1/state")).power;
      return left === 0 && right === 0;
    }, "the robot to stand");
    await page.waitForTimeout(1500);
    assert.equal(await speed(its.robot), 0, "and it does not set off again by itself");
  });
});
