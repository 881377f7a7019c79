// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { newPresses, readPad } from "../../../web/src/drive/gamepad";
import { stickOf } from "../../../web/src/drive/keyboard";
import { Steering } from "../../../web/src/drive/steering";
import { shaped, twistOf } from "../../../web/src/drive/stick";
import type { Twist } from "../../../web/src/link/types";

describe("a stick", () => {
  it("has a dead zone, a fine middle and all at the rim", () => {
    assert.equal(shaped(0.05), 0);
    assert.equal(shaped(NaN), 0);
    assert.ok(shaped(0.5) > 0.1 && shaped(0.5) < 0.4);
    assert.equal(shaped(1), 1);
    assert.equal(shaped(-1), -1);
    assert.equal(shaped(7), 1);
  });
  it("grows without a step", () => {
    let before = 0;
    for (let share = 0; share <= 1; share += 0.01) {
      assert.ok(shaped(share) >= before && shaped(share) - before < 0.04);
      before = shaped(share);
    }
  });
  it("has no minus zeros to send", () => {
    assert.equal(JSON.stringify(twistOf({ ahead: -0.01, left: -0 }, { speed_mps: 1, turn_radps: 1 })), '{"v":0,"w":0}');
  });
});

describe("keys", () => {
  it("add up, and cancel each other", () => {
    assert.deepEqual(stickOf(new Set(["KeyW", "ArrowLeft"])), { ahead: 1, left: 0.8 });
    assert.deepEqual(stickOf(new Set(["KeyW", "KeyS"])), { ahead: 0, left: 0 });
    assert.deepEqual(stickOf(new Set(["KeyW", "ArrowUp", "KeyQ"])), { ahead: 1, left: 0 });
  });
});

const pad = (change: { axes?: Record<number, number>; values?: Record<number, number>; pressed?: number[] } = {}) => ({
  mapping: "standard",
  connected: true,
  axes: [0, 1, 2, 3].map((axis) => change.axes?.[axis] ?? 0),
  buttons: Array.from({ length: 17 }, (_, button) => ({ value: change.values?.[button] ?? 0, pressed: change.pressed?.includes(button) ?? false })),
});

describe("a gamepad", () => {
  it("drives with the triggers, steers with the left stick, pans with the right one", () => {
    const reading = readPad(pad({ values: { 7: 1, 6: 0.25 }, axes: { 0: 0.5, 2: -0.5, 3: 0.05 } }));
    assert.deepEqual(reading.stick, { ahead: 0.75, left: -0.5 });
    assert.deepEqual(reading.pan, { x: -0.5, y: 0 });
  });
  it("does not drift", () => {
    assert.deepEqual(readPad(pad({ axes: { 0: 0.1, 1: -0.1 }, values: { 7: 0.05 } })).stick, { ahead: 0, left: 0 });
  });
  it("tells a press once, and none of what was down when it was plugged in", () => {
    const down = readPad(pad({ pressed: [0, 5] }));
    assert.deepEqual(newPresses(down, null), []);
    assert.deepEqual(newPresses(down, readPad(pad())), ["togglePilot", "morePower"]);
    assert.deepEqual(newPresses(down, down), []);
  });
  it("with fewer buttons is no trouble", () => {
    assert.deepEqual(readPad({ mapping: "standard", connected: true, axes: [], buttons: [] }).stick, { ahead: 0, left: 0 });
  });
});

describe("steering", () => {
  const start = () => {
    const driven: Twist[] = [];
    return { driven, steering: new Steering((twist) => driven.push(twist)), last: () => driven[driven.length - 1]! };
  };
  it("follows what was moved last, and falls back to what is still pushed", () => {
    const { steering, last } = start();
    steering.set("keys", { ahead: 1, left: 0 });
    assert.ok(last().v > 0);
    steering.set("joystick", { ahead: -1, left: 0 });
    assert.ok(last().v < 0);
    steering.set("joystick", { ahead: 0, left: 0 });
    assert.ok(last().v > 0);
  });
  it("stands after a release until the stick was let go and pushed again", () => {
    const { steering, last } = start();
    steering.set("gamepad", { ahead: 1, left: 0 });
    steering.release();
    assert.deepEqual(last(), { v: 0, w: 0 });
    steering.set("gamepad", { ahead: 0.9, left: 0 });
    assert.deepEqual(last(), { v: 0, w: 0 });
    steering.set("gamepad", { ahead: 0, left: 0 });
    steering.set("gamepad", { ahead: 1, left: 0 });
    assert.ok(last().v > 0);
  });
  it("released lets another source drive", () => {
    const { steering, last } = start();
    steering.set("gamepad", { ahead: 1, left: 0 });
    steering.release();
    steering.set("keys", { ahead: 0, left: 1 });
    assert.ok(last().w > 0);
    steering.set("keys", { ahead: 0, left: 0 });
    assert.deepEqual(last(), { v: 0, w: 0 });
  });
});
