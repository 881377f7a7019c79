// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import type { Answer } from "../../../web/src/map/map_jobs";
import { idleHand } from "../../../web/src/map/map_hand";
import { MapPainter, TILE_SIDE } from "../../../web/src/map/map_painter";
import { colourTable, DARK, LIGHT, paintCells } from "../../../web/src/map/palette";
import { Pyramid } from "../../../web/src/map/pyramid";

const FREE = 0x47;
const WALL = 0x87;
const SIDE = 64;

function chunkWith(cells: [x: number, y: number, byte: number][]): Uint8Array {
  const chunk = new Uint8Array(SIDE * SIDE);
  for (const [x, y, byte] of cells) chunk[y * SIDE + x] = byte;
  return chunk;
}

function goldenMap(): ArrayBuffer {
  return Uint8Array.from(readFileSync(`${process.env.GOLDEN}/map.bin`)).buffer;
}

function rgba(pixels: Uint8ClampedArray, x: number, y: number): number[] {
  return [...pixels.subarray(4 * (y * TILE_SIDE + x), 4 * (y * TILE_SIDE + x) + 4)];
}

test("colours: unknown is clear, walls are told from floor, the surer the stronger", () => {
  for (const palette of [LIGHT, DARK]) {
    const bytes = new Uint8Array(colourTable(palette).buffer);
    const colour = (byte: number) => [...bytes.subarray(4 * byte, 4 * byte + 4)];
    const rgb = (value: number) => [value >> 16, (value >> 8) & 255, value & 255, 255];
    for (const unknown of [0, 7]) assert.deepEqual(colour(unknown), [0, 0, 0, 0]);
    assert.deepEqual(colour(0x40), rgb(palette.free[0]));
    assert.deepEqual(colour(0x47), rgb(palette.free[1]));
    assert.deepEqual(colour(0x80), rgb(palette.occupied[0]));
    assert.deepEqual(colour(0x87), rgb(palette.occupied[1]));
    const far = (a: number[], b: number[]) => Math.abs(a[0]! - b[0]!);
    for (let sure = 1; sure < 8; ++sure) assert.ok(far(colour(0x80 + sure), colour(0x47)) >= far(colour(0x80 + sure - 1), colour(0x47)));
  }
});

test("the highest row of cells is the first of the picture, the lowest x its left", () => {
  const picture = new Uint32Array(SIDE * SIDE);
  const colours = Uint32Array.from({ length: 256 }, (_, byte) => byte);
  paintCells(chunkWith([[3, 63, WALL], [10, 0, FREE]]), colours, picture, SIDE, 0, 0);
  assert.equal(picture[3], WALL);
  assert.equal(picture[63 * SIDE + 10], FREE);
  assert.equal(picture.filter((pixel) => pixel !== 0).length, 2);
});

test("a tile puts its chunks where they are, also those left of and below the origin", () => {
  const painter = new MapPainter();
  const chunks = painter.take(goldenMap()).chunks;
  assert.ok(chunks.some(({ x }) => x < 0));
  for (const { x, y } of chunks) {
    const pixels = painter.paint({ level: 0, x: x >> 2, y: y >> 2 });
    assert.ok(pixels);
    const left = (x & 3) * SIDE;
    const top = (3 - (y & 3)) * SIDE;
    let known = 0;
    for (let row = 0; row < SIDE; ++row) for (let column = 0; column < SIDE; ++column) known += rgba(pixels, left + column, top + row)[3]! > 0 ? 1 : 0;
    assert.ok(known > 0, `chunk ${x}, ${y} is painted in its place`);
  }
  assert.equal(painter.paint({ level: 0, x: 1000, y: 1000 }), null);
});

test("each level halves the one before; a wall stays a wall, at its place", () => {
  const pyramid = new Pyramid();
  pyramid.put(-1, 2, chunkWith([[5, 9, WALL], [4, 9, FREE], [4, 8, FREE], [40, 40, FREE]]));
  const one = pyramid.at(1, -1, 1)!;
  assert.equal(one[(0 + 4) * SIDE + 32 + 2], WALL); // chunk -1 is the right half of -1, chunk 2 the lower half of 1
  assert.equal(one[20 * SIDE + 32 + 20], FREE);
  assert.equal(one.filter((cell) => cell !== 0).length, 2);
  const two = pyramid.at(2, -1, 0)!;
  assert.equal(two[(32 + 2) * SIDE + 48 + 1], WALL);
  pyramid.put(-1, 2, chunkWith([]));
  assert.ok(two.every((cell) => cell === 0), "what is gone from a chunk is gone from all levels");
});

test("the chunks of one map do not stay in the next", () => {
  const painter = new MapPainter();
  const [first] = painter.take(goldenMap()).chunks;
  const empty = new Uint8Array(24);
  empty[0] = 2;
  empty[8] = 99; // another map
  painter.take(empty.buffer);
  assert.equal(painter.paint({ level: 0, x: first!.x >> 2, y: first!.y >> 2 }), null);
});

test("without a worker the page paints by itself, a little at a time", () => {
  const slices: (() => void)[] = [];
  const said: Answer[] = [];
  globalThis.ImageData ??= class { constructor(readonly data: Uint8ClampedArray, readonly width: number) {} } as unknown as typeof ImageData;
  const hand = idleHand((answer) => said.push(answer), (work) => slices.push(work));
  hand.ask({ kind: "map", bytes: goldenMap() });
  hand.ask({ kind: "paint", tiles: [{ level: 0, x: 0, y: 0 }, { level: 0, x: 1000, y: 0 }] });
  hand.ask({ kind: "map", bytes: new ArrayBuffer(3) });
  assert.equal(said.length, 0, "not at once");
  while (slices.length > 0) slices.shift()!();
  assert.deepEqual(said.map(({ kind }) => kind), ["news", "picture", "picture", "trouble"]);
  const pictures = said.filter((answer) => answer.kind === "picture").map(({ picture }) => picture);
  assert.equal(pictures[0]?.width, TILE_SIDE);
  assert.equal(pictures[1], null);
});
