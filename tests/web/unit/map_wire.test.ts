// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import { cellOf, encodeHave, parseMapMessage, parsePicture } from "../../../web/src/link/wire";

function golden(name: string): ArrayBuffer {
  return Uint8Array.from(readFileSync(`${process.env.GOLDEN}/${name}`)).buffer;
}

function withByte(bytes: ArrayBuffer, at: number, value: number): ArrayBuffer {
  const changed = new Uint8Array(bytes.slice(0));
  changed[at] = value;
  return changed.buffer;
}

test("a map message as the robot sends it", () => {
  const message = parseMapMessage(golden("map.bin"));
  assert.equal(message.isLast, true);
  assert.equal(message.mapId, 0x1122334455667788n);
  assert.ok(Math.abs(message.cellSize_m - 0.02) < 1e-6);
  assert.equal(message.t_s, 99.25);
  assert.equal(message.chunks.length, 2);
  for (const chunk of message.chunks) assert.equal(chunk.cells.length, 64 * 64);
});

test("a map message cut short anywhere is refused", () => {
  const whole = golden("map.bin");
  for (let length = 0; length < whole.byteLength; ++length) assert.throws(() => parseMapMessage(whole.slice(0, length)), `${length} bytes`);
});

test("a message of another kind is no map message", () => {
  const whole = golden("map.bin");
  for (let kind = 0; kind < 256; ++kind) if (kind !== 2) assert.throws(() => parseMapMessage(withByte(whole, 0, kind)), /not a map message/);
});

test("a map message with another number of chunks than it says is refused", () => {
  for (const count of [1, 3, 255]) assert.throws(() => parseMapMessage(withByte(golden("map.bin"), 2, count)));
});

test("what a client has is said as the robot reads it", () => {
  const said = encodeHave(0x1122334455667788n, [
    { x: 0, y: 0, version: 7 },
    { x: -3, y: 250, version: 6 },
  ]);
  assert.equal(said.byteLength, 32);
  assert.deepEqual(Buffer.from(said), Buffer.from(golden("map_have.bin")));
});

test("a picture, whole and cut short", () => {
  const whole = golden("video.bin");
  assert.deepEqual(Buffer.from(parsePicture(whole).jpeg), Buffer.from(whole).subarray(16));
  for (let length = 0; length < 16; ++length) assert.throws(() => parsePicture(whole.slice(0, length)), /cut short/);
  for (let kind = 0; kind < 256; ++kind) if (kind !== 3) assert.throws(() => parsePicture(withByte(whole, 0, kind)), /not a picture/);
});

test("what a cell's byte says", () => {
  assert.deepEqual(cellOf(0), { kind: "unknown", sure: 0 });
  assert.deepEqual(cellOf(0x45), { kind: "free", sure: 5 });
  assert.deepEqual(cellOf(0x87), { kind: "occupied", sure: 7 });
});
