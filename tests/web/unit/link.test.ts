// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { afterEach, beforeEach, describe, it } from "node:test";
import { Heartbeat } from "../../../web/src/link/heartbeat";
import { RobotClock } from "../../../web/src/link/robot_clock";

describe("the robot's clock", () => {
  it("tells ages by the message that came fastest", () => {
    const clock = new RobotClock();
    assert.equal(clock.age_ms(1, 0), null);
    clock.hear(10, 500_040); // 40 ms on the way
    clock.hear(10.1, 500_105); // 5 ms
    clock.hear(10.2, 500_230); // 30 ms
    assert.equal(Math.round(clock.age_ms(10.2, 500_230)!), 25);
    assert.equal(clock.age_ms(20, 500_230), 0);
  });
  it("forgets a minute later that the way was short once, as clocks drift", () => {
    const clock = new RobotClock();
    clock.hear(0, 0);
    for (let s = 1; s < 70; s++) clock.hear(s, 1000 * s + 50);
    assert.equal(Math.round(clock.age_ms(70, 70_050)!), 0);
  });
  it("begins anew with a robot that began anew", () => {
    const clock = new RobotClock();
    clock.hear(5000, 1000);
    clock.hear(1, 3000);
    assert.equal(Math.round(clock.age_ms(1, 3020)!), 20);
  });
});

/** Runs what is to happen every so often when told to. */
function fakeInterval(): (beats: number) => void {
  let running: (() => void) | null = null;
  globalThis.setInterval = ((action: () => void) => ((running = action), 1)) as unknown as typeof setInterval;
  globalThis.clearInterval = () => (running = null);
  return (beats) => {
    for (let i = 0; i < beats; i++) running?.();
  };
}

describe("the heartbeat", () => {
  const real = { setInterval, clearInterval };
  let tick: (beats: number) => void;
  beforeEach(() => (tick = fakeInterval()));
  afterEach(() => Object.assign(globalThis, real));

  const start = () => {
    const sent: { seq: number; v: number; w: number }[] = [];
    const time = { ms: 0, open: true };
    const heartbeat = new Heartbeat(
      (message) => {
        if (time.open) sent.push(JSON.parse(message) as (typeof sent)[0]);
        return time.open;
      },
      () => time.ms,
    );
    return { heartbeat, sent, time };
  };
  it("says nothing before it is started", () => {
    const { heartbeat, sent } = start();
    heartbeat.want({ v: 1, w: 0 });
    assert.deepEqual(sent, []);
  });
  it("says a change at once, but not too fast, and a standstill always", () => {
    const { heartbeat, sent, time } = start();
    heartbeat.start();
    heartbeat.want({ v: 1, w: 0 });
    time.ms = 5;
    heartbeat.want({ v: 0.9, w: 0 });
    assert.deepEqual(sent.map((m) => m.v), [1]);
    heartbeat.want({ v: 0, w: 0 });
    assert.deepEqual(sent.map((m) => m.v), [1, 0]);
    tick(2);
    assert.deepEqual(sent.map((m) => m.v), [1, 0, 0, 0]);
    assert.ok(sent.every((m, i) => i === 0 || m.seq > sent[i - 1]!.seq));
    heartbeat.stop();
  });
  it("ends with standing still, and then says nothing", () => {
    const { heartbeat, sent } = start();
    heartbeat.start();
    heartbeat.want({ v: 1, w: 1 });
    heartbeat.stop();
    tick(10);
    assert.deepEqual(sent.map((m) => [m.v, m.w]), [[1, 1], [0, 0]]);
  });
  it("measures how long an answer takes, and how long one is missing", () => {
    const { heartbeat, sent, time } = start();
    heartbeat.start();
    tick(1);
    time.ms = 30;
    assert.equal(heartbeat.waiting_ms(), 30);
    assert.equal(heartbeat.answered(sent[0]!.seq), 30);
    assert.equal(heartbeat.waiting_ms(), 0);
    assert.equal(heartbeat.answered(sent[0]!.seq), null);
    time.open = false;
    tick(1);
    assert.equal(heartbeat.waiting_ms(), 0, "what was not sent is not waited for");
    heartbeat.stop();
  });
  it("does not steer while answers are late, nor after that before the driver has let go", () => {
    const { heartbeat, sent, time } = start();
    const last = () => sent[sent.length - 1]!;
    heartbeat.start();
    heartbeat.want({ v: 1, w: 0 });
    time.ms = 250;
    tick(1);
    assert.equal(last().v, 0);
    heartbeat.answered(last().seq);
    time.ms = 300;
    tick(1);
    assert.equal(last().v, 0);
    heartbeat.answered(last().seq);
    heartbeat.want({ v: 0, w: 0 });
    heartbeat.want({ v: 0.5, w: 0 });
    time.ms = 350;
    tick(1);
    assert.equal(last().v, 0.5);
    heartbeat.stop();
  });
});
