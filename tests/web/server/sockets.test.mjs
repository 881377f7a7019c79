// SPDX-License-Identifier: MIT
// The WebSockets as web/wire.md describes them.
import assert from "node:assert/strict";
import { once } from "node:events";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { inflateSync } from "node:zlib";
import { checkSchema } from "./contract.mjs";
import { Driver, Robot, sleep, until } from "./robot.mjs";

let robot;
before(async () => { robot = await Robot.start(); });
after(() => robot.stop());

const closed = (socket, ms = 10000) => until(() => socket.closedWith, "the socket to close", ms);

test("state: ten times a second what the contract says", async () => {
  const socket = await robot.open("state");
  await until(() => socket.inbox.at(-1)?.pose, "a pose");
  const n = socket.inbox.length;
  await sleep(2000);
  const got = socket.inbox.slice(n);
  assert.ok(got.length >= 12 && got.length <= 25, `${got.length} in 2 s`);
  for (const state of got) checkSchema("State", state);
  assert.ok(got.at(-1).t_s > got[0].t_s + 1);
  assert.ok(got.at(-1).scan.ranges_cm.filter((cm) => cm > 0).length > 180);
  socket.send("hello");
  assert.equal((await closed(socket)).code, 1003);
});

/** Takes a message of the map apart. */
function mapMessage(bytes) {
  assert.equal(bytes[0], 2);
  const message = {
    all: bytes[1] === 1, count: bytes.readUInt16LE(2), cellSize: bytes.readFloatLE(4), id: bytes.readBigUInt64LE(8),
    time: bytes.readDoubleLE(16), chunks: [],
  };
  const raw = inflateSync(bytes.subarray(24));
  assert.equal(raw.length, 4112 * message.count);
  for (let at = 0; at < raw.length; at += 4112)
    message.chunks.push({
      x: raw.readInt16LE(at), y: raw.readInt16LE(at + 2), version: raw.readUInt32LE(at + 4),
      changed: raw.readDoubleLE(at + 8), cells: raw.subarray(at + 16, at + 4112),
    });
  return message;
}
function mapHave(id = 0n, chunks = []) {
  const bytes = Buffer.alloc(16 + 8 * chunks.length);
  bytes.writeUInt32LE(1, 0);
  bytes.writeUInt32LE(chunks.length, 4);
  bytes.writeBigUInt64LE(id, 8);
  chunks.forEach(({ x, y, version }, i) => {
    bytes.writeInt16LE(x, 16 + 8 * i);
    bytes.writeInt16LE(y, 18 + 8 * i);
    bytes.writeUInt32LE(version, 20 + 8 * i);
  });
  return bytes;
}
/** All of the map, once the robot has sent it. */
async function wholeMap(have, robot) {
  const socket = await robot.open("map");
  socket.send(have);
  const messages = () => socket.inbox.map(mapMessage);
  await until(() => socket.inbox.length > 0 && messages().some((m) => m.all), "the map");
  const got = messages();
  socket.close();
  return got;
}

test("the golden messages mean to another reader what they mean to ours", () => {
  const golden = (name) => readFileSync(new URL(`../../../web/golden/${name}`, import.meta.url));
  const map = mapMessage(golden("map.bin"));
  assert.deepEqual([map.all, map.count, map.id, map.time], [true, 2, 0x1122334455667788n, 99.25]);
  assert.ok(Math.abs(map.cellSize - 0.02) < 1e-8);
  const [, chunk] = map.chunks;
  assert.deepEqual([chunk.x, chunk.y, chunk.version, chunk.changed], [-3, 250, 7, 12.5]);
  assert.deepEqual([chunk.cells[0], chunk.cells[5 * 64 + 63] >> 6, chunk.cells[6 * 64 + 19]], [0, 2, 64 + 7]);
  assert.ok(golden("map_have.bin").equals(mapHave(0x1122334455667788n, [{ x: 0, y: 0, version: 7 }, { x: -3, y: 250, version: 6 }])));
  const video = golden("video.bin");
  assert.deepEqual([video.readUInt32LE(0), video.readUInt32LE(4), video.readDoubleLE(8), video.length], [3, 3, 4.5, 20]);
});

test("map: everything once, the nearest first; then only what is newer", async (t) => {
  const robot = await Robot.start("--fault", "lidar:unplugged:3");  // what it sees no more does not change
  t.after(() => robot.stop());
  await until(async () => (await robot.metric("dynslam_map_chunks")) > 15, "a map");
  await until(async () => (await robot.json("/api/v1/devices")).devices.lidar.trouble, "the lidar to be gone", 20000);
  await sleep(500);
  const messages = await wholeMap(mapHave(), robot);
  const seen = new Map();
  for (const m of messages) for (const c of m.chunks) seen.set(`${c.x},${c.y}`, c);
  assert.ok(seen.size > 15, `${seen.size} chunks`);
  const first = messages.find((m) => m.count > 0).chunks;
  const distance = ({ x, y }) => Math.hypot(x, y);
  assert.ok(distance(first[0]) <= 1.5, "the robot stands near the origin");
  for (let i = 1; i < first.length; ++i) assert.ok(distance(first[i]) >= distance(first[i - 1]) - 2.9);
  const states = [...first[0].cells].map((cell) => cell >> 6);
  assert.ok(states.includes(1), "floor around the robot");
  const [{ id }] = messages;

  const back = await wholeMap(mapHave(id, [...seen.values()]), robot);
  assert.deepEqual(back.flatMap((m) => m.chunks), []);
  assert.ok(back.at(-1).all);
  const [one, ...others] = seen.values();
  const lacking = await wholeMap(mapHave(id, [{ ...one, version: one.version - 1 }, ...others]), robot);
  assert.deepEqual(lacking.flatMap((m) => m.chunks).map(({ x, y, version }) => [x, y, version]), [[one.x, one.y, one.version]]);

  const stranger = await wholeMap(mapHave(id + 2n, [...seen.values()]), robot);
  assert.ok(stranger.flatMap((m) => m.chunks).length === seen.size, "of another map it has nothing");
});

test("map: what makes no sense closes the socket", async () => {
  for (const message of ["map please", Buffer.alloc(0), Buffer.alloc(16), mapHave().subarray(0, 15), Buffer.concat([mapHave(), Buffer.alloc(8)])]) {
    const socket = await robot.open("map");
    socket.send(message);
    assert.equal((await closed(socket)).code, 1003);
  }
  const twice = await robot.open("map");
  twice.send(mapHave());
  twice.send(mapHave());
  assert.equal((await closed(twice)).code, 1003);
});

test("video: the newest, at the client's pace; the camera rests when nobody looks", async () => {
  const fast = await robot.open("video"), slow = await robot.open("video"), deaf = await robot.open("video");
  fast.on("message", (data) => fast.send(`{"ack":${data.readUInt32LE(4)}}`));
  slow.on("message", (data) => setTimeout(() => slow.readyState === 1 && slow.send(`{"ack":${data.readUInt32LE(4)}}`), 400));
  await sleep(3000);
  assert.equal((await robot.json("/api/v1/state")).watchers, 3);
  assert.ok(fast.inbox.length > 6, `${fast.inbox.length}`);
  assert.ok(slow.inbox.length >= 3 && slow.inbox.length <= 18, `${slow.inbox.length}`);
  assert.equal(deaf.inbox.length, 2, "no more than two are on the way");
  for (const bytes of fast.inbox) assert.equal(bytes.readUInt16BE(16), 0xffd8);
  const stamps = slow.inbox.map((bytes) => bytes.readDoubleLE(8));
  assert.ok(fast.inbox.at(-1).readDoubleLE(8) - stamps.at(-1) < 1.5, "what is slow is not old");
  for (let i = 1; i < stamps.length; ++i) assert.ok(stamps[i] > stamps[i - 1]);
  slow.send('{"ack":4000000}');
  assert.equal((await closed(slow)).code, 1003);
  fast.close();
  deaf.terminate();
  await until(async () => (await robot.json("/api/v1/state")).watchers === 0, "the camera to rest");
});

test("control: one drives, the others look on; the wheel is taken over on request", async () => {
  const ada = await Driver.take(robot);
  await ada.drives();
  const bob = await robot.open("control");
  bob.send('{"lease":"acquire"}');
  await until(() => bob.inbox.some((m) => /somebody else/.test(m.error ?? "")), "the refusal");
  bob.send('{"seq":1,"v":0.5,"w":0}');
  bob.send('{"lease":"take_over"}');
  await until(() => bob.inbox.some((m) => m.wheel?.mine), "the wheel");
  assert.ok(!bob.inbox.some((m) => m.ack !== undefined), "without the wheel nothing is commanded");
  await until(() => ada.socket.inbox.some((m) => m.wheel?.mine === false && m.wheel.driver), "Ada to hear of it");
  ada.drop();
  await sleep(200);
  assert.ok((await robot.json("/api/v1/state")).driver, "who has no wheel loses none");
  bob.send('{"lease":"release"}');
  await until(async () => (await robot.json("/api/v1/state")).driver === null, "the wheel to be free");
  bob.close();
});

test("control: the robot drives as it is told, within what it can do", async () => {
  const driver = await Driver.take(robot);
  await driver.drives();
  driver.wish = { v: 0, w: 1000 };
  await until(async () => (await robot.json("/api/v1/state")).applied.w_radps > 1, "a turn");
  assert.ok((await robot.json("/api/v1/state")).applied.w_radps <= 3.0001);
  driver.wish = { v: 0, w: 0 };
  await until(async () => (await robot.json("/api/v1/state")).applied.w_radps === 0, "standing still");
  await driver.leave();
});

test("control: bad messages are refused in words and counted, and do no harm", async () => {
  const driver = await Driver.take(robot);
  await driver.drives();
  const refused = await robot.event("server.control_messages_refused");
  const bad = ['{"seq":1,"v":NaN,"w":0}', '{"seq":1,"v":1e999,"w":0}', "", "null", "{", '{"fly":true}', '{"seq":-1,"v":0,"w":0}', '{"lease":"steal"}'];
  for (const text of bad) driver.socket.send(text);
  await until(() => driver.socket.inbox.filter((m) => m.error).length === bad.length, "the refusals");
  assert.equal((await robot.event("server.control_messages_refused")) - refused, bad.length);
  assert.ok(driver.socket.inbox.filter((m) => m.error).every((m) => m.error.length > 5));
  const outOfOrder = await robot.event("server.control_out_of_order");
  driver.socket.send(`{"seq":${driver.seq},"v":9,"w":0}`);
  driver.socket.send('{"seq":0,"v":9,"w":0}');
  await until(async () => (await robot.event("server.control_out_of_order")) === outOfOrder + 2, "both to be dropped");
  await sleep(300);
  assert.notEqual(driver.last.motion, "stop", driver.last.reason);
  driver.socket.send('{"stop":true}');
  await until(() => driver.last.motion === "e-stop", "the stop");
  assert.equal((await robot.post("/api/v1/clear_stop")).status, 204);
  await driver.leave();
});

test("control: who floods is cut, and only he", async () => {
  const driver = await Driver.take(robot);
  await driver.drives();
  const flooding = await robot.open("control");
  for (let i = 0; i < 2000; ++i) flooding.send('{"seq":1,"v":1,"w":0}');
  assert.equal((await closed(flooding)).code, 1008);
  driver.last = undefined;
  await driver.drives();
  assert.equal(driver.socket.closedWith, undefined);
  await driver.leave();
});

/** A frame by hand, with a mask of zeros. */
const frame = (first, length, payload = Buffer.alloc(0)) => {
  const head = Buffer.alloc(14);
  head[0] = first;
  head[1] = 0x80 | 127;
  head.writeBigUInt64BE(BigInt(length), 2);
  return Buffer.concat([head, payload]);
};
test("frames that are fragmented, compressed, unmasked, unknown or too long close the socket at once", async () => {
  const frames = [[frame(0x01, 2, Buffer.from("hi")), 1003], [frame(0x80, 2, Buffer.from("hi")), 1003], [frame(0xc1, 0), 1002],
    [frame(0x87, 0), 1002], [Buffer.from([0x81, 0x02, 0x68, 0x69]), 1002], [frame(0x81, 2n ** 62n), 1009], [frame(0x82, 2n ** 31n), 1009],
    [frame(0x89, 126), 1002]];
  for (const kind of ["control", "state", "map", "video"]) {
    for (const [bytes, code] of frames) {
      const socket = await robot.open(kind);
      socket._socket.write(bytes);
      assert.equal((await closed(socket)).code, code, `${kind} ${bytes.toString("hex")}`);
    }
  }
});

test("what is no WebSocket is told so", async () => {
  const upgrade = (path, extra = "") => robot.rawAnswer(
    `GET ${path} HTTP/1.1\r\nHost: ${robot.host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n${extra}\r\n`);
  assert.match(await upgrade("/api/v1/ws/nothing", "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"), /^HTTP\/1.1 404/);
  assert.match(await upgrade("/api/v1/ws/state"), /^HTTP\/1.1 400/);
  assert.match(await upgrade("/api/v1/ws/state", "Sec-WebSocket-Version: 12\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"), /^HTTP\/1.1 426/);
  const answer = await robot.fetch("/api/v1/ws/state");
  assert.equal(answer.status, 404);
});

test("a ping is answered with what it said", async () => {
  const socket = await robot.open("state");
  socket.ping("are you there");
  const [payload] = await once(socket, "pong");
  assert.equal(String(payload), "are you there");
  socket.close();
  await closed(socket);
});
