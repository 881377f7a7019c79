// SPDX-License-Identifier: MIT
// How long it takes from thumb to motor and from sensor to screen, what it costs the phone and the network. Figures
// are printed; asserted with slack, as the machine of a test may be busy.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { spread, spreadText } from "../server/robot.mjs";
import { drives, Finger, middle, ready, Stage, stands } from "./browser.mjs";

const its = new Stage();
const SLACK = 3;

/** Notes when something is touched, and what goes over the sockets because of it. */
function tap() {
  const Real = window.WebSocket;
  window.bytes = {};
  window.taps = [];
  window.addEventListener("pointermove", ({ timeStamp }) => (window.moved_ms = timeStamp), { capture: true });
  window.WebSocket = class extends Real {
    constructor(url) {
      super(url);
      const kind = String(url).split("/").pop();
      window.bytes[kind] ??= 0;
      const sent = new Map();
      this.addEventListener("message", ({ data }) => {
        window.bytes[kind] += typeof data === "string" ? data.length : data.byteLength;
        if (kind !== "control") return;
        const { driven, ack } = JSON.parse(data);
        if (sent.has(ack)) sent.get(ack).delay_ms ??= performance.now() - sent.get(ack).sent_ms;
        const answered = driven && sent.get(driven.seq);
        if (answered && answered.isFirst) window.taps.push(answered.sent_ms - answered.tapped_ms + answered.delay_ms / 2 + driven.ms);
      });
      if (kind !== "control") return;
      let stood = true;
      const send = this.send.bind(this);
      this.send = (text) => {
        const { seq, v } = JSON.parse(text);
        if (seq !== undefined) sent.set(seq, { sent_ms: performance.now(), tapped_ms: window.moved_ms, isFirst: stood && v !== 0 });
        stood = v === 0;
        send(text);
      };
    }
  };
}

const told = (name, values, limit_ms) => {
  const s = spread(values);
  const p95 = [...values].sort((a, b) => a - b)[Math.floor(0.95 * values.length)];
  console.log(`${name}: ${spreadText(s)}, p95 ${p95.toFixed(1)} ms (goal ${limit_ms})`);
  assert.ok(values.length >= 10, `${name}: enough of them`);
  assert.ok(p95 < SLACK * limit_ms, `${name}: ${p95} ms`);
};

describe("figures", () => {
  it("from thumb to motor", async () => {
    const page = await its.open("phone", { prepare: (page) => page.addInitScript(tap) });
    await ready(page, its.robot);
    const finger = await Finger.of(page);
    const { x, y } = await middle(page.locator(".joystick"));
    // Of two commands in one tick of the robot only the second is answered: that tap does not count.
    const counted = () => page.evaluate(() => window.taps.length);
    for (let i = 0; i < 80 && (await counted()) < 20; i++) {
      await finger.down(x, y);
      await page.waitForTimeout(7 * (i % 8)); // at any moment of the 20 ms of the robot's tick
      await finger.move(x, i % 2 ? y + 25 : y - 25);
      await drives(its.robot);
      await finger.up();
      await stands(its.robot);
    }
    told("from a thumb's move to the motors", await page.evaluate(() => window.taps), 60);
  });

  it("from sensor to screen, and bytes a minute", async () => {
    const page = await its.open("phone", { prepare: (page) => page.addInitScript(tap) });
    await ready(page, its.robot);
    await page.evaluate(() => {
      window.ages = { scan: [], video: [] };
      const { scanAge_ms, videoAge_ms } = window.dynslam;
      scanAge_ms.subscribe((age) => age !== null && window.ages.scan.push(age));
      videoAge_ms.subscribe((age) => age !== null && window.ages.video.push(age));
    });
    const from = await page.evaluate(() => ({ ...window.bytes }));
    await page.keyboard.down("KeyA");
    await page.waitForTimeout(15000);
    await page.keyboard.up("KeyA");
    const { ages, bytes } = await page.evaluate(() => ({ ages: window.ages, bytes: window.bytes }));
    for (const kind of ["control", "state", "map", "video"])
      console.log(`${kind}: ${((4 * (bytes[kind] - from[kind])) / 1e3).toFixed(0)} kB a minute while the robot turns`);
    told("from a scan's end to the screen", ages.scan, 150);
    told("from a picture taken to the screen", ages.video, 100);
  });

  it("of the page's thread while driving", async () => {
    const page = await its.open("phone");
    await ready(page, its.robot);
    const session = await page.context().newCDPSession(page);
    await session.send("Performance.enable");
    const metrics = async () => Object.fromEntries((await session.send("Performance.getMetrics")).metrics.map(({ name, value }) => [name, value]));
    await page.evaluate(() => {
      window.long = [];
      window.frames = 0;
      new PerformanceObserver((list) => window.long.push(...list.getEntries().map((task) => task.duration))).observe({ type: "longtask" });
      const count = () => { window.frames++; requestAnimationFrame(count); };
      requestAnimationFrame(count);
    });
    const before = await metrics();
    await page.keyboard.down("KeyA");
    await page.waitForTimeout(10000);
    await page.keyboard.up("KeyA");
    const after = await metrics();
    const { long, frames } = await page.evaluate(() => ({ long: window.long, frames: window.frames }));
    const perFrame = (1e3 * (after.ScriptDuration - before.ScriptDuration)) / frames;
    console.log(`scripting ${perFrame.toFixed(2)} ms a frame (goal 4) over ${frames} frames; tasks over 50 ms: ${long.map((ms) => ms.toFixed(0)).join(" ") || "none"}`);
    console.log(`heap ${(after.JSHeapUsedSize / 1e6).toFixed(1)} MB`);
    assert.ok(perFrame < 4 * SLACK);
  });
});
