// SPDX-License-Identifier: MIT
import type { MapNews, MapPainter, Pixels, Tile } from "./map_painter";
import type { Palette } from "./palette";

/** What the page wants of whoever paints the map for it. */
export type Job = { kind: "palette"; palette: Palette } | { kind: "map"; bytes: ArrayBuffer } | { kind: "paint"; tiles: Tile[] };

/** A picture of TILE_SIDE pixels a side; null where nothing is known. */
export type TilePicture = ImageBitmap | ImageData | null;

export type Answer = { kind: "news"; news: MapNews } | { kind: "picture"; tile: Tile; picture: TilePicture } | { kind: "trouble"; why: string };

export interface Listener {
  say: (answer: Answer) => void;
  paintedTo: (tile: Tile, pixels: Pixels | null) => void;
}

export function doJob(painter: MapPainter, job: Job, { say, paintedTo }: Listener): void {
  try {
    if (job.kind === "palette") painter.setPalette(job.palette);
    else if (job.kind === "map") say({ kind: "news", news: painter.take(job.bytes) });
    else for (const tile of job.tiles) paintedTo(tile, painter.paint(tile));
  } catch (error) {
    say({ kind: "trouble", why: (error as Error).message });
  }
}
