// SPDX-License-Identifier: MIT
import type { TilePicture } from "./map_jobs";
import { type Tile, TILE_SHIFT } from "./map_painter";

export function tileName({ level, x, y }: Tile): string {
  return `${level}/${x}/${y}`;
}

interface Watched {
  tile: Tile;
  draw: (picture: TilePicture) => void;
  isDue: boolean;
}

/** The tiles that somebody shows now, and which of them are not as the map is. */
export class TileWatch {
  /** While set, only tiles that were never drawn are asked for; the others are brought up to date afterwards. */
  private isHeld = false;
  private readonly tiles = new Map<string, Watched>();
  private readonly fresh = new Set<string>();
  private readonly levels = new Map<number, number>();

  constructor(private readonly onDue: () => void) {}

  /** `draw` is called with each new picture; the picture is gone afterwards. */
  add(tile: Tile, draw: (picture: TilePicture) => void): void {
    const name = tileName(tile);
    if (!this.tiles.has(name)) this.levels.set(tile.level, (this.levels.get(tile.level) ?? 0) + 1);
    this.tiles.set(name, { tile, draw, isDue: true });
    this.fresh.add(name);
    this.onDue();
  }

  remove(tile: Tile): void {
    if (!this.tiles.delete(tileName(tile))) return;
    this.fresh.delete(tileName(tile));
    const left = this.levels.get(tile.level)! - 1;
    if (left > 0) this.levels.set(tile.level, left);
    else this.levels.delete(tile.level);
  }

  clear(): void {
    this.tiles.clear();
    this.fresh.clear();
    this.levels.clear();
  }

  hold(isHeld: boolean): void {
    this.isHeld = isHeld;
    if (!isHeld) this.onDue();
  }

  /** A chunk has changed. */
  spoil(chunkX: number, chunkY: number): void {
    for (const level of this.levels.keys()) {
      const shift = TILE_SHIFT + level;
      const watched = this.tiles.get(tileName({ level, x: chunkX >> shift, y: chunkY >> shift }));
      if (watched) watched.isDue = true;
    }
  }

  spoilAll(): void {
    for (const watched of this.tiles.values()) watched.isDue = true;
  }

  /** The tiles to be painted, but for those that are `pending`; they are due no more. */
  takeDue(pending: ReadonlySet<string>): Tile[] {
    const due: Tile[] = [];
    for (const [name, watched] of this.tiles) {
      if (!watched.isDue || pending.has(name) || (this.isHeld && !this.fresh.has(name))) continue;
      watched.isDue = false;
      due.push(watched.tile);
    }
    return due;
  }

  show(tile: Tile, picture: TilePicture): void {
    const name = tileName(tile);
    this.fresh.delete(name);
    this.tiles.get(name)?.draw(picture);
  }
}

/** Puts a picture of a tile onto its canvas. */
export function drawTile(canvas: HTMLCanvasElement, picture: TilePicture): void {
  if (!picture) {
    canvas.width = canvas.height = 0; // where nothing is known, nothing is held
    return;
  }
  if (canvas.width !== picture.width) canvas.width = canvas.height = picture.width;
  const context = canvas.getContext("2d")!;
  if (picture instanceof ImageData) {
    context.putImageData(picture, 0, 0);
  } else {
    context.clearRect(0, 0, picture.width, picture.height);
    context.drawImage(picture, 0, 0);
  }
}
