// SPDX-License-Identifier: MIT
/** The map's cells at several scales. Pure; used on the page's thread and in its worker. */
import { CHUNK_SIDE } from "../link/wire";

/** At the highest level, a cell stands for 2^TOP_LEVEL cells a side. */
export const TOP_LEVEL = 5;
const HALF = CHUNK_SIDE / 2;

/** A number for a place on a grid of +-32768. */
export function placeKey(x: number, y: number): number {
  return (x + 32768) * 65536 + (y + 32768);
}

/**
 * Squares of 64 x 64 cells: those of level 0 are the chunks, four of them make one of the next level, at half the scale.
 * A byte a cell, and a third more for all higher levels together.
 */
export class Pyramid {
  private readonly levels = Array.from({ length: TOP_LEVEL + 1 }, () => new Map<number, Uint8Array>());

  /** Takes a chunk, and what follows from it on all levels. */
  put(x: number, y: number, cells: Uint8Array): void {
    this.square(0, x, y).set(cells);
    for (let level = 1; level <= TOP_LEVEL; ++level) {
      const child = this.square(level - 1, x, y);
      const at = (y & 1) * HALF * CHUNK_SIDE + (x & 1) * HALF;
      x >>= 1;
      y >>= 1;
      halve(child, this.square(level, x, y), at);
    }
  }

  /** The cells there, row by row from the lowest y, each from the lowest x. */
  at(level: number, x: number, y: number): Uint8Array | undefined {
    return this.levels[level]?.get(placeKey(x, y));
  }

  clear(): void {
    for (const level of this.levels) level.clear();
  }

  private square(level: number, x: number, y: number): Uint8Array {
    const squares = this.levels[level]!;
    const key = placeKey(x, y);
    const found = squares.get(key);
    if (found) return found;
    const made = new Uint8Array(CHUNK_SIDE * CHUNK_SIDE);
    squares.set(key, made);
    return made;
  }
}

/**
 * Of four cells the greatest byte stays: occupied before free before unknown, and the surest of them. So a wall of one
 * cell is never lost, however far away one looks.
 */
function halve(child: Uint8Array, parent: Uint8Array, at: number): void {
  for (let row = 0; row < HALF; ++row) {
    for (let column = 0; column < HALF; ++column) {
      const from = 2 * row * CHUNK_SIDE + 2 * column;
      const low = Math.max(child[from]!, child[from + 1]!);
      const high = Math.max(child[from + CHUNK_SIDE]!, child[from + CHUNK_SIDE + 1]!);
      parent[at + row * CHUNK_SIDE + column] = Math.max(low, high);
    }
  }
}
