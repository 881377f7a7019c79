// SPDX-License-Identifier: MIT
/** The binary messages of wire.md. Pure; used on the page's thread and in its worker. */
import { unzlibSync } from "fflate";

export const CHUNK_SIDE = 64;
const CHUNK_HEAD = 16;
const CHUNK_BYTES = CHUNK_HEAD + CHUNK_SIDE * CHUNK_SIDE;
const MAP_HEAD = 24;
const MAP_KIND = 2;
const MAP_HAVE_KIND = 1;
const PICTURE_KIND = 3;
const PICTURE_HEAD = 16;

/** A square of the map. Cells row by row from the lowest y, each row from the lowest x. */
export interface Chunk {
  x: number;
  y: number;
  version: number;
  /** When a cell of it changed last, by the robot's clock. */
  changed_s: number;
  cells: Uint8Array;
}

export interface MapMessage {
  /** Nothing newer was known when these were picked. */
  isLast: boolean;
  cellSize_m: number;
  mapId: bigint;
  t_s: number;
  chunks: Chunk[];
}

export interface Picture {
  number: number;
  taken_s: number;
  jpeg: Uint8Array<ArrayBuffer>;
}

/** What a client has of a chunk. */
export interface Held {
  x: number;
  y: number;
  version: number;
}

export class WireError extends Error {}

export function parseMapMessage(bytes: ArrayBuffer): MapMessage {
  if (bytes.byteLength < MAP_HEAD) throw new WireError("a map message is cut short");
  const head = new DataView(bytes);
  if (head.getUint8(0) !== MAP_KIND) throw new WireError("not a map message");
  const count = head.getUint16(2, true);
  const unpacked = count > 0 ? unzlibSync(new Uint8Array(bytes, MAP_HEAD)) : new Uint8Array();
  if (unpacked.length !== count * CHUNK_BYTES) throw new WireError("a map message holds another number of chunks than it says");
  return {
    isLast: (head.getUint8(1) & 1) !== 0,
    cellSize_m: head.getFloat32(4, true),
    mapId: head.getBigUint64(8, true),
    t_s: head.getFloat64(16, true),
    chunks: Array.from({ length: count }, (_, i) => parseChunk(unpacked, i * CHUNK_BYTES)),
  };
}

function parseChunk(bytes: Uint8Array, at: number): Chunk {
  const head = new DataView(bytes.buffer, bytes.byteOffset + at, CHUNK_HEAD);
  return {
    x: head.getInt16(0, true),
    y: head.getInt16(2, true),
    version: head.getUint32(4, true),
    changed_s: head.getFloat64(8, true),
    cells: bytes.subarray(at + CHUNK_HEAD, at + CHUNK_BYTES),
  };
}

/** The first message of a client of the map: what it has, of which map (0: of none). */
export function encodeHave(mapId: bigint, held: Held[]): ArrayBuffer {
  const bytes = new ArrayBuffer(16 + 8 * held.length);
  const view = new DataView(bytes);
  view.setUint32(0, MAP_HAVE_KIND, true);
  view.setUint32(4, held.length, true);
  view.setBigUint64(8, mapId, true);
  held.forEach((chunk, i) => {
    view.setInt16(16 + 8 * i, chunk.x, true);
    view.setInt16(18 + 8 * i, chunk.y, true);
    view.setUint32(20 + 8 * i, chunk.version, true);
  });
  return bytes;
}

export function parsePicture(bytes: ArrayBuffer): Picture {
  if (bytes.byteLength < PICTURE_HEAD) throw new WireError("a picture is cut short");
  const head = new DataView(bytes);
  if (head.getUint32(0, true) !== PICTURE_KIND) throw new WireError("not a picture");
  return { number: head.getUint32(4, true), taken_s: head.getFloat64(8, true), jpeg: new Uint8Array(bytes, PICTURE_HEAD) };
}

export type CellClass = "unknown" | "free" | "occupied";

/** What a cell's byte says; `sure` from 0 to 7. */
export function cellOf(byte: number): { kind: CellClass; sure: number } {
  const kind = byte >> 6 === 2 ? "occupied" : byte >> 6 === 1 ? "free" : "unknown";
  return { kind, sure: byte & 7 };
}
