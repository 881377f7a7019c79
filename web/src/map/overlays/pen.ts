// SPDX-License-Identifier: MIT
import type { Point } from "../geometry";
import type { Inks } from "../look";

/** What an overlay draws with: a canvas in CSS pixels, and where a place of the map is on it. */
export interface Pen {
  context: CanvasRenderingContext2D;
  inks: Inks;
  pixelsPerMetre: number;
  width: number;
  height: number;
  at: (point: Point) => [x: number, y: number];
}

const HATCH_PX = 8;

export type Overlay = (pen: Pen) => void;

/** Moves along the points; the caller strokes. */
export function tracePath({ context, at }: Pen, points: readonly Point[]): void {
  points.forEach((point, i) => (i === 0 ? context.moveTo(...at(point)) : context.lineTo(...at(point))));
}

/** Strokes the present path with a halo under it. */
export function strokeWithHalo({ context, inks }: Pen, ink: string, width: number): void {
  context.lineJoin = context.lineCap = "round";
  context.strokeStyle = inks.halo;
  context.lineWidth = width + 3;
  context.stroke();
  context.strokeStyle = ink;
  context.lineWidth = width;
  context.stroke();
}

/** Words beside a place, readable on anything. */
export function write({ context, inks }: Pen, text: string, x: number, y: number, ink: string): void {
  context.font = "600 13px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.lineJoin = "round";
  context.strokeStyle = inks.halo;
  context.lineWidth = 4;
  context.strokeText(text, x, y);
  context.fillStyle = ink;
  context.fillText(text, x, y);
}

/** Lines from the left below to the right above, where `where` is; fixed to the map, so that they do not swim when it is moved. */
export function hatch({ context, width, height, at }: Pen, where: Path2D, ink: string, strength: number): void {
  context.save();
  context.clip(where, "evenodd");
  context.beginPath();
  const [x, y] = at({ x: 0, y: 0 });
  const first = (((x + y) % HATCH_PX) + HATCH_PX) % HATCH_PX;
  for (let sum = first; sum < width + height; sum += HATCH_PX) {
    context.moveTo(sum, 0);
    context.lineTo(sum - height, height);
  }
  context.strokeStyle = ink;
  context.globalAlpha = strength;
  context.lineWidth = 1;
  context.stroke();
  context.restore();
}
