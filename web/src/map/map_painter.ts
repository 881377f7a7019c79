// SPDX-License-Identifier: MIT
/** From the messages of the socket `map` to pictures. Pure; used in the worker, and on the page's thread where there is none. */
import { CHUNK_SIDE, type Held, parseMapMessage } from "../link/wire";
import { colourTable, LIGHT, paintCells, type Palette } from "./palette";
import { Pyramid } from "./pyramid";

/** A picture is of 4 x 4 squares of the pyramid. */
const TILE_SQUARES = 4;
export const TILE_SIDE = TILE_SQUARES * CHUNK_SIDE;
/** Which tile of level 0 a chunk is in: its place, shifted by this. */
export const TILE_SHIFT = 2;

/** Tile (x, y) of a level covers TILE_SIDE * 2^level cells a side, y up. */
export interface Tile {
  level: number;
  x: number;
  y: number;
}

export type ChunkNews = Held & { changed_s: number };

/** What a message brought. */
export interface MapNews {
  mapId: bigint;
  cellSize_m: number;
  isLast: boolean;
  chunks: ChunkNews[];
}

export type Pixels = Uint8ClampedArray<ArrayBuffer>;

export class MapPainter {
  private readonly pyramid = new Pyramid();
  private colours = colourTable(LIGHT);
  private mapId = 0n;

  setPalette(palette: Palette): void {
    this.colours = colourTable(palette);
  }

  /** Throws when the message is not as in wire.md; then nothing of it was taken. */
  take(bytes: ArrayBuffer): MapNews {
    const message = parseMapMessage(bytes);
    if (message.mapId !== this.mapId) this.pyramid.clear();
    this.mapId = message.mapId;
    for (const chunk of message.chunks) this.pyramid.put(chunk.x, chunk.y, chunk.cells);
    return {
      mapId: message.mapId,
      cellSize_m: message.cellSize_m,
      isLast: message.isLast,
      chunks: message.chunks.map(({ x, y, version, changed_s }) => ({ x, y, version, changed_s })),
    };
  }

  /** RGBA, TILE_SIDE pixels a side, its first row the highest; null where nothing is known. */
  paint(tile: Tile): Pixels | null {
    let picture: Uint32Array<ArrayBuffer> | null = null;
    for (let row = 0; row < TILE_SQUARES; ++row) {
      for (let column = 0; column < TILE_SQUARES; ++column) {
        const cells = this.pyramid.at(tile.level, TILE_SQUARES * tile.x + column, TILE_SQUARES * tile.y + row);
        if (!cells) continue;
        picture ??= new Uint32Array(TILE_SIDE * TILE_SIDE);
        paintCells(cells, this.colours, picture, TILE_SIDE, column * CHUNK_SIDE, (TILE_SQUARES - 1 - row) * CHUNK_SIDE);
      }
    }
    return picture && new Uint8ClampedArray(picture.buffer);
  }
}
