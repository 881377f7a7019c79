// SPDX-License-Identifier: MIT
// A driver drives while others kill, stall and flood. What is asserted has slack for slow machines; the figures that
// count are printed.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import net from "node:net";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { Driver, Robot, sleep, spread, spreadText, until } from "./robot.mjs";

const kSlack = Number(process.env.SLACK ?? 1);  // sanitizers are slow
let robot;
before(async () => { robot = await Robot.start("--world", "office"); });
after(() => robot.stop());

/** Drives in circles for a while; what was measured. */
async function drive(seconds) {
  const driver = await Driver.take(robot);
  await driver.drives();
  driver.wish = { v: 0.15, w: 0.8 };
  let lost = 0;
  driver.socket.on("message", (data) => {
    if (/nothing heard|nobody is driving/.test(String(data))) ++lost;
  });
  driver.roundTrips = [];
  driver.motorDelays = [];
  const began = driver.seq;
  await sleep(1000 * seconds);
  const measured = {
    sent: driver.seq - began, lost,
    roundTrip: spread(driver.roundTrips), motor: spread(driver.motorDelays),
  };
  await driver.leave();
  return measured;
}
function tell(what, m) {
  console.log(`${what}: ${m.sent} commands, lost ${m.lost} times\n  round trip: ${spreadText(m.roundTrip)}\n  command to motor: ${spreadText(m.motor)}`);
}

test("a driver alone", async () => {
  const m = await drive(5);
  tell("alone", m);
  assert.equal(m.lost, 0);
  assert.ok(m.motor.n > 80);
  assert.ok(m.motor.p99 < 60 * kSlack);
});

test("the heartbeat holds with 8 clients that watch the video", async () => {
  const watching = await Promise.all(Array.from({ length: 8 }, async () => {
    const video = await robot.open("video");
    video.on("message", (data) => video.send(`{"ack":${data.readUInt32LE(4)}}`));
    return video;
  }));
  const m = await drive(5);
  tell("with 8 that watch", m);
  const pictures = watching.map((video) => video.inbox.length);
  console.log(`  pictures: ${pictures}`);
  for (const video of watching) video.terminate();
  assert.equal(m.lost, 0);
  assert.ok(m.motor.p99 < 60 * kSlack);
  assert.ok(Math.min(...pictures) > 20 / kSlack);
  await until(async () => (await robot.json("/api/v1/state")).watchers === 0, "the camera to rest");
});

test("a driver is not disturbed by those who kill, stall and flood", async () => {
  const script = fileURLToPath(new URL("attacker.mjs", import.meta.url));
  const attacker = spawn(process.execPath, [script, String(robot.port), "15"], { stdio: ["ignore", "pipe", "inherit"] });
  let did = "";
  attacker.stdout.on("data", (text) => { did += text; });
  await sleep(500);
  const stopping = stopNowAndThen(10);
  stopping.catch(() => {});  // told below, when the driver has left
  const m = await drive(12);
  const stops = await stopping;
  tell("under attack", m);
  console.log(`  STOP over a new connection: ${spreadText(spread(stops))}`);
  const [code] = await once(attacker, "exit");
  console.log(`  attacks: ${did.trim()}`);
  assert.equal(code, 0);
  assert.equal(robot.process.exitCode, null, robot.output);
  assert.equal(m.lost, 0);
  assert.ok(m.motor.p99 < 100 * kSlack);
  assert.ok(Math.max(...stops) < 2000 * kSlack);
  await until(async () => (await robot.json("/api/v1/state")).watchers === 0, "the camera to rest", 20000);
});

/** Times answers of the least path that is always open, as STOP would keep the driver from driving. */
async function stopNowAndThen(seconds) {
  const times = [];
  const end = Date.now() + 1000 * seconds;
  while (Date.now() < end) {
    const began = performance.now();
    const raw = await robot.rawAnswer(`GET /api/v1/stop HTTP/1.1\r\nHost: ${robot.host}\r\n\r\n`);
    assert.match(raw, /^HTTP\/1.1 405/);
    times.push(performance.now() - began);
    await sleep(100);
  }
  return times;
}

test("idle connections are closed after five seconds, and hold nobody up meanwhile", async () => {
  const idle = await Promise.all(Array.from({ length: 60 }, async (_, i) => {
    const socket = net.connect({ port: robot.port, host: "127.0.0.1", localAddress: `127.0.2.${1 + (i % 3)}` });
    socket.on("error", () => {});
    socket.resume();
    await once(socket, "connect");
    return socket;
  }));
  const began = Date.now();
  const raw = await robot.rawAnswer(`POST /api/v1/stop HTTP/1.1\r\nHost: ${robot.host}\r\n\r\n`);
  assert.match(raw, /^HTTP\/1.1 204/);
  console.log(`STOP with 60 idle connections: ${Date.now() - began} ms`);
  assert.ok(Date.now() - began < 2000 * kSlack);
  await Promise.all(idle.map((socket) => socket.closed || once(socket, "close")));
  console.log(`idle ones closed after ${Date.now() - began} ms`);
  assert.ok(Date.now() - began < 9000 * kSlack);
  assert.equal((await robot.post("/api/v1/clear_stop")).status, 204);
});

test("the motors are off soon after a driver's socket is gone", async () => {
  const delays = [];
  for (let i = 0; i < 8; ++i) {
    const driver = await Driver.take(robot);
    await driver.drives();
    driver.wish = { v: 0.05, w: i % 2 ? 1 : -1 };
    await until(async () => Math.abs((await robot.json("/api/v1/state")).power.left) > 0.01, "the motors to run");
    const before = await robot.metric("dynslam_drop_to_off_seconds_sum");
    const n = await robot.metric("dynslam_drop_to_off_seconds_count");
    driver.drop();
    await until(async () => (await robot.metric("dynslam_drop_to_off_seconds_count")) > n, "the motors to be off");
    delays.push(1000 * ((await robot.metric("dynslam_drop_to_off_seconds_sum")) - before));
    const state = await robot.json("/api/v1/state");
    assert.deepEqual(state.power, { left: 0, right: 0 });
    assert.equal(state.driver, null);
  }
  const s = spread(delays);
  console.log(`socket gone to motors off: ${spreadText(s)}`);
  assert.ok(s.max < 100 * kSlack);
});
