// SPDX-License-Identifier: MIT
import "./map.css";
import { effect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { robot } from "../robot";
import { strings } from "../strings";
import { inks } from "./look";
import { mapModel } from "./map_model";
import { type Tile, TILE_SIDE } from "./map_painter";
import { drawRobot } from "./overlays/robot_overlay";
import { drawTile, tileName } from "./tile_watch";

/** Metres and pixels a side. */
const SIZES = {
  small: { side_m: 6, side_px: 112 },
  medium: { side_m: 10, side_px: 168 },
  large: { side_m: 16, side_px: 240 },
};
const EVERY_MS = 100;
const ROBOT_PX = 16;

/** The map around the robot, north up. */
export function Minimap({ size, onTap }: { size: keyof typeof SIZES; onTap?: () => void }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => showMinimap(canvas.current!, SIZES[size].side_m, SIZES[size].side_px), [size]);
  return (
    <button type="button" class={`minimap minimap-${size}`} aria-label={strings.map.minimap} title={strings.map.minimap} onClick={onTap}>
      <canvas ref={canvas} />
      <span>{`${SIZES[size].side_m} m`}</span>
    </button>
  );
}

/** Draws when something has changed, until what it gives is called. */
function showMinimap(canvas: HTMLCanvasElement, side_m: number, side_px: number): () => void {
  canvas.width = canvas.height = Math.round(side_px * Math.min(2, window.devicePixelRatio));
  const stopUsing = mapModel.use();
  const tiles = new MinimapTiles(() => drawSoon());
  let timer = 0;
  let frame = 0;
  const draw = () => drawMinimap(canvas, tiles, side_m);
  const drawSoon = () => {
    if (timer !== 0) return;
    timer = window.setTimeout(() => {
      timer = 0;
      frame = requestAnimationFrame(draw); // none while the tab is hidden
    }, EVERY_MS);
  };
  const stopWatching = effect(() => {
    void [robot.state.value?.pose, inks.value, mapModel.cellSize_m.value];
    drawSoon();
  });
  return () => {
    clearTimeout(timer);
    cancelAnimationFrame(frame);
    stopWatching();
    tiles.end();
    stopUsing();
  };
}

/** Where the canvas is on the map: its left upper corner, and how large a cell is. */
interface Window {
  left_m: number;
  top_m: number;
  pixelsPerMetre: number;
}

function drawMinimap(canvas: HTMLCanvasElement, tiles: MinimapTiles, side_m: number): void {
  const pose = robot.state.peek()?.pose;
  const cellSize_m = mapModel.cellSize_m.peek();
  const context = canvas.getContext("2d")!;
  context.clearRect(0, 0, canvas.width, canvas.height);
  if (!pose || cellSize_m === 0) return;
  const pixelsPerMetre = canvas.width / side_m;
  const shown = { left_m: pose.x_m - side_m / 2, top_m: pose.y_m + side_m / 2, pixelsPerMetre };
  const level = Math.max(0, Math.round(-Math.log2(pixelsPerMetre * cellSize_m)));
  tiles.draw(context, level, TILE_SIDE * cellSize_m * 2 ** level, shown, side_m);
  const robot_px = (ROBOT_PX * canvas.width) / canvas.clientWidth;
  drawRobot(context, inks.peek(), pose, canvas.width / 2, canvas.height / 2, robot_px);
}

/** The tiles around the robot. */
class MinimapTiles {
  private readonly watch = mapModel.watch();
  private readonly canvases = new Map<string, { tile: Tile; canvas: HTMLCanvasElement }>();

  constructor(private readonly onPicture: () => void) {}

  draw(context: CanvasRenderingContext2D, level: number, tile_m: number, { left_m, top_m, pixelsPerMetre }: Window, side_m: number): void {
    const seen = new Set<string>();
    const [firstX, lastX] = [Math.floor(left_m / tile_m), Math.floor((left_m + side_m) / tile_m)];
    const [firstY, lastY] = [Math.floor((top_m - side_m) / tile_m), Math.floor(top_m / tile_m)];
    for (let x = firstX; x <= lastX; ++x) {
      for (let y = firstY; y <= lastY; ++y) {
        const tile = { level, x, y };
        seen.add(tileName(tile));
        const canvas = this.canvasOf(tile);
        const px = (metres: number) => metres * pixelsPerMetre;
        if (canvas.width > 0) context.drawImage(canvas, px(x * tile_m - left_m), px(top_m - (y + 1) * tile_m), px(tile_m), px(tile_m));
      }
    }
    this.dropAllBut(seen);
  }

  end(): void {
    this.watch.clear();
    mapModel.unwatch(this.watch);
  }

  private canvasOf(tile: Tile): HTMLCanvasElement {
    const found = this.canvases.get(tileName(tile));
    if (found) return found.canvas;
    const canvas = document.createElement("canvas");
    canvas.width = canvas.height = 0;
    this.canvases.set(tileName(tile), { tile, canvas });
    this.watch.add(tile, (picture) => {
      drawTile(canvas, picture);
      this.onPicture();
    });
    return canvas;
  }

  private dropAllBut(seen: ReadonlySet<string>): void {
    for (const [name, { tile }] of this.canvases) {
      if (seen.has(name)) continue;
      this.watch.remove(tile);
      this.canvases.delete(name);
    }
  }
}
