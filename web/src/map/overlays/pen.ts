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
