// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { indicators, type Seen } from "../../../web/src/indicators/indicators";
import type { Autopilot, State } from "../../../web/src/link/types";

const state: State = {
  t_s: 1,
  pose: { t_s: 1, x_m: 0, y_m: 0, yaw_rad: 0, covariance: { xx_m2: 0, xy_m2: 0, yy_m2: 0, yaw_rad2: 0 }, quality: 0.9, lost: false, unsteady: null },
  mode: "manual",
  map_id: "20261126-144501",
  notes_version: 1,
  autopilot: null,
  verdict: { motion: "go", cause: "none", reason: "" },
  applied: { v_mps: 0, w_radps: 0 },
  power: { left: -0.25, right: 0.1 },
  battery: { voltage_v: 12.6, share: 0.8, level: "good", brownout: false },
  power_limit: 0.5,
  attitude: { roll_rad: 0, pitch_rad: 0, yaw_radps: 0 },
  collision: false,
  scan: null,
  recording: null,
  driver: null,
  watchers: 0,
  counters: {},
};
const pilot: Autopilot = { mode: "navigate", phase: "active", reason: "", goal: null, route: [], remaining_m: null, places: [], nearest: null };

function seen(change: Partial<State> = {}, rest: Partial<Seen> = {}) {
  const all: Seen = {
    state: { ...state, ...change }, phase: "up", wheel: { mine: true, driver: "Ada" }, mayDrive: true, delay_ms: 12, videoAge_ms: 40, ...rest,
  };
  return Object.fromEntries(indicators(all).map((indicator) => [indicator.id, indicator]));
}

describe("the indicators", () => {
  it("of a robot that is well say little", () => {
    const loud = Object.values(seen()).filter((i) => i.level === "warn" || i.level === "bad");
    assert.deepEqual(loud, []);
    assert.equal(seen().power!.text, "25 %");
  });
  it("each have a word on what they mean when they are shown", () => {
    for (const indicator of Object.values(seen())) if (indicator.level !== "off") assert.ok(indicator.text && indicator.about.length > 10, indicator.id);
  });
  it("tell the autopilot's states", () => {
    const of = (change: Partial<Autopilot>) => seen({ autopilot: { ...pilot, ...change } });
    assert.equal(seen().autopilot!.text, "By hand");
    assert.equal(of({}).autopilot!.level, "good");
    assert.equal(of({ phase: "idle" }).autopilot!.text, "Nothing to do");
    assert.equal(of({ phase: "stopped", reason: "it is stuck" }).autopilot!.about, "it is stuck");
    assert.equal(of({}).navigation!.text, "No destination");
    const goal = { x_m: 1, y_m: 2 };
    assert.equal(of({ goal, route: [[0, 0], [1, 2]], remaining_m: 2.24 }).navigation!.text, "On the way 2.2 m");
    assert.equal(of({ goal, phase: "stopped" }).navigation!.text, "No route");
    assert.equal(of({ mode: "explore" }).exploration!.level, "good");
    assert.equal(of({ mode: "explore", phase: "idle" }).exploration!.level, "off", "it has seen all");
    assert.equal(of({ mode: "explore" }).navigation!.level, "off");
  });
  it("tell the battery's", () => {
    const of = (level: "good" | "low" | "recharge" | "unknown", brownout = false) => seen({ battery: { ...state.battery!, level, brownout } });
    assert.equal(of("good").battery!.level, "good");
    assert.equal(of("low").battery!.level, "warn");
    assert.equal(of("recharge").battery!.level, "bad");
    assert.equal(of("unknown").battery!.level, "plain");
    assert.equal(of("low", true).brownout!.level, "bad");
    assert.equal(seen({ battery: null }).battery!.level, "plain");
  });
  it("tell what is in the way", () => {
    const verdict = { motion: "slow", cause: "obstacle", reason: "obstacle 0.20 m ahead" } as const;
    assert.equal(seen({ verdict }).near!.level, "warn");
    assert.equal(seen({ verdict: { ...verdict, motion: "hold" } }).near!.level, "bad");
    assert.equal(seen({ verdict }).near!.about, verdict.reason);
    assert.equal(seen({ collision: true }).collision!.level, "bad");
    assert.equal(seen({ collision: null }).collision!.level, "off");
  });
  it("tell why the robot does not move", () => {
    const stop = (cause: "scan" | "driver" | "e-stop") => ({ motion: "stop", cause, reason: `because of ${cause}` }) as const;
    assert.equal(seen({ verdict: stop("scan") }).standing!.level, "bad");
    assert.equal(seen({ verdict: stop("scan") }).standing!.about, "because of scan");
    assert.equal(seen({ verdict: stop("driver") }).standing!.level, "warn");
    assert.equal(seen({ verdict: stop("driver") }, { wheel: { mine: false, driver: null } }).standing!.level, "off", "nobody wants to drive");
    assert.equal(seen({ verdict: stop("e-stop") }).standing!.level, "off", "the banner tells of it");
  });
  it("tell what spoils the map", () => {
    assert.equal(seen({ pose: { ...state.pose!, unsteady: "turning" } }).yaw!.level, "warn");
    assert.equal(seen({ pose: { ...state.pose!, unsteady: "tilting" } }).tilt!.level, "warn");
    assert.equal(seen({ verdict: { motion: "stop", cause: "tilt", reason: "leans" } }).tilt!.level, "bad");
    assert.equal(seen({ pose: { ...state.pose!, lost: true } }).lost!.level, "bad");
    assert.equal(seen({ pose: { ...state.pose!, quality: 0.2 } }).pose!.level, "warn");
  });
  it("tell of the link, the wheel, the video and the recording", () => {
    assert.equal(seen({}, { phase: "lost" }).link!.level, "bad");
    assert.equal(seen({}, { delay_ms: 150 }).link!.level, "warn");
    assert.equal(seen({}, { wheel: { mine: false, driver: "Bob" } }).wheel!.text, "Bob drives");
    assert.equal(seen({}, { wheel: { mine: false, driver: null }, mayDrive: false }).wheel!.text, "Watching");
    assert.equal(seen({}, { videoAge_ms: null }).video!.level, "warn");
    assert.equal(seen({}, { videoAge_ms: undefined }).video!.level, "off");
    const recording = { active: true, asked_for: true, file: "a.mcap", bytes: 1, messages: 1, seconds: 65, dropped: 0, trouble: "" };
    assert.equal(seen({ recording }).recording!.text, "Rec 1:05");
    assert.equal(seen({ recording: { ...recording, active: false, trouble: "the disk is full" } }).recording!.about, "the disk is full");
    assert.equal(seen({ recording: { ...recording, asked_for: false } }).recording!.level, "off", "the ring is always there");
  });
  it("without any state tell of the link and the wheel", () => {
    assert.deepEqual(Object.keys(Object.fromEntries(indicators({ state: null, phase: "connecting", wheel: { mine: false, driver: null }, mayDrive: true, delay_ms: null, videoAge_ms: null }).map((i) => [i.id, i]))), ["wheel", "link", "video"]);
  });
});
