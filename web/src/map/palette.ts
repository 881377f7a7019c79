// SPDX-License-Identifier: MIT
/** The colours of the map's cells. Pure; used on the page's thread and in its worker. */
import { cellOf, CHUNK_SIDE } from "../link/wire";

/** Colours as 0xRRGGBB, of the least sure cell and of the surest. Unknown cells are clear. */
export interface Palette {
  free: [number, number];
  occupied: [number, number];
}

export const LIGHT: Palette = { free: [0xe9eceb, 0xffffff], occupied: [0x7a8187, 0x05080a] };
export const DARK: Palette = { free: [0x262d32, 0x343d44], occupied: [0x93a3ad, 0xffffff] };

const SUREST = 7;

/** The colour of each cell's byte as the 32 bits of an RGBA pixel, lowest byte first, as every browser's machine has it. */
export function colourTable(palette: Palette): Uint32Array {
  return Uint32Array.from({ length: 256 }, (_, byte) => {
    const { kind, sure } = cellOf(byte);
    if (kind === "unknown") return 0;
    const [from, to] = palette[kind];
    return pixelOf(mix(from, to, sure / SUREST));
  });
}

/** Paints a chunk's cells into a picture `width` pixels wide. Cells go up, pictures go down: it is turned here, and only here. */
export function paintCells(cells: Uint8Array, colours: Uint32Array, picture: Uint32Array, width: number, left: number, top: number): void {
  for (let row = 0; row < CHUNK_SIDE; ++row) {
    const from = (CHUNK_SIDE - 1 - row) * CHUNK_SIDE;
    const to = (top + row) * width + left;
    for (let column = 0; column < CHUNK_SIDE; ++column) picture[to + column] = colours[cells[from + column]!]!;
  }
}

function mix(from: number, to: number, share: number): number {
  const part = (shift: number) => {
    const a = (from >> shift) & 255;
    return Math.round(a + (((to >> shift) & 255) - a) * share) << shift;
  };
  return part(16) | part(8) | part(0);
}

function pixelOf(rgb: number): number {
  return (0xff000000 | ((rgb & 255) << 16) | (rgb & 0xff00) | (rgb >> 16)) >>> 0;
}
