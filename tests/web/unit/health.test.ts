// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { test } from "node:test";
import { advice, conditionOf } from "../../../web/src/more/advice";
import { meaningOf, RisingCounters } from "../../../web/src/more/counters";

const works = { present: true, samples: 40, errors: 0, last_sample_s: 4, trouble: "" };
const DEVICES = ["lidar", "imu", "motors", "camera", "pins", "sonar"];

test("a device that works needs no advice", () => {
  for (const device of DEVICES) {
    assert.equal(conditionOf(device, works, 100), "good");
    assert.equal(advice(device, works, 100), null);
    assert.equal(advice(device, works, null), null, "before the robot's clock is known");
  }
});

test("a device that is not there, says nothing or has trouble is told of, with what to do", () => {
  for (const device of DEVICES) {
    assert.equal(conditionOf(device, { present: false }, null), "absent");
    assert.equal(conditionOf(device, { ...works, trouble: "Input/output error" }, 100), "trouble");
    assert.equal(conditionOf(device, works, 3000), device === "camera" ? "resting" : "silent");
    for (const health of [{ present: false }, { ...works, trouble: "Input/output error" }]) assert.ok(advice(device, health, 100)!.length > 20);
  }
});

test("trouble counts more than silence, and errors that are over count for nothing", () => {
  assert.equal(conditionOf("lidar", { ...works, trouble: "timeout" }, 9000), "trouble");
  assert.equal(conditionOf("lidar", { ...works, errors: 7 }, 100), "good");
});

test("advice tells for how long there were no data", () => {
  assert.match(advice("lidar", works, 3000)!, /^No data for 3\.0 s: is its motor turning\?/);
  assert.match(advice("lidar", { present: true, samples: 0 }, null)!, /^No data yet: is its motor turning\?/);
  assert.match(advice("sonar", works, 65000)!, /^No data for 1:05: check its cable/);
});

test("a device that may not be opened is a matter of groups, not of cables", () => {
  const refused = { ...works, trouble: "cannot open /dev/ttyUSB0: Permission denied" };
  assert.match(advice("lidar", refused, 100)!, /group dialout/);
  assert.match(advice("imu", refused, 100)!, /group i2c/);
});

test("the robot drives without a camera", () => {
  assert.match(advice("camera", { present: false }, null)!, /drives without/);
});

test("a counter has risen when it did while one looked, for ten seconds", () => {
  const rising = new RisingCounters();
  rising.see({ a: 5, b: 1 }, 0);
  assert.equal(rising.hasRisen("a", 0), false);
  rising.see({ a: 6, b: 1, c: 1 }, 2000);
  assert.deepEqual(["a", "b", "c", "d"].map((name) => rising.hasRisen(name, 2000)), [true, false, true, false]);
  rising.see({ a: 6, b: 1, c: 1 }, 11999);
  assert.equal(rising.hasRisen("a", 11999), true);
  assert.equal(rising.hasRisen("a", 12000), false);
});

test("a robot that began anew counts from below without rising", () => {
  const rising = new RisingCounters();
  rising.see({ a: 5 }, 0);
  rising.see({ a: 1 }, 2000);
  assert.equal(rising.hasRisen("a", 2000), false);
});

test("counters are explained, by their family where each has no words of its own", () => {
  assert.match(meaningOf("slam.scans_unmatched"), /fit nowhere/);
  assert.match(meaningOf("loops.refused.poor score"), /^loops refused: poor score$/);
  assert.equal(meaningOf("nobody.knows"), "");
});
