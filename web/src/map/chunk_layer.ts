// SPDX-License-Identifier: MIT
import { type Coords, CRS, type DoneCallback, extend, GridLayer, type LatLngExpression, Transformation } from "leaflet";
import type { Point } from "./geometry";
import { mapModel } from "./map_model";
import { type Tile, TILE_SIDE } from "./map_painter";
import { TOP_LEVEL } from "./pyramid";
import { drawTile } from "./tile_watch";

/** At zoom 0 a cell is a pixel. */
export const MOST_ZOOM = 5;

/** Metres of the frame `map`: lat is y, lng is x. Pixels are counted in cells, so that tiles lie on whole pixels. */
export function crsOf(cellSize_m: number): CRS {
  return extend({}, CRS.Simple, { transformation: new Transformation(1 / cellSize_m, 0, -1 / cellSize_m, 0) });
}

export function latLng({ x, y }: Point): LatLngExpression {
  return [y, x];
}

/** The cells. Each tile shows a level of the pyramid, and is drawn anew when the map has changed there. */
export class ChunkLayer extends GridLayer {
  private readonly watch = mapModel.watch();

  constructor() {
    super({ tileSize: TILE_SIDE, minZoom: -TOP_LEVEL, maxZoom: MOST_ZOOM, maxNativeZoom: 0, keepBuffer: 1, updateWhenIdle: false, className: "cells" });
    this.on("tileunload", ({ coords }: { coords: Coords }) => this.watch.remove(tileAt(coords)));
  }

  protected override createTile(coords: Coords, done: DoneCallback): HTMLElement {
    const canvas = document.createElement("canvas");
    canvas.width = canvas.height = 0;
    const tile = tileAt(coords);
    canvas.dataset.tile = `${tile.level}/${tile.x}/${tile.y}`; // to find it by
    let isDone = false;
    this.watch.add(tile, (picture) => {
      drawTile(canvas, picture);
      if (!isDone) done(undefined, canvas);
      isDone = true;
    });
    return canvas;
  }

  /** While held, what was drawn stays as it is. */
  hold(isHeld: boolean): void {
    this.watch.hold(isHeld);
  }

  end(): void {
    this.remove();
    mapModel.unwatch(this.watch);
  }
}

/** Leaflet counts tiles downwards. */
function tileAt({ x, y, z }: Coords): Tile {
  return { level: -z, x, y: -y - 1 };
}
