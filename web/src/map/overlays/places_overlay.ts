// SPDX-License-Identifier: MIT
import type { Autopilot } from "../../link/types";
import { robot } from "../../robot";
import { type Pen, strokeWithHalo } from "./pen";

type Kind = Autopilot["places"][number]["kind"];

/** Told apart by shape, not by colour alone. */
const SHAPES: Record<Kind, readonly (readonly [number, number])[]> = {
  frontier: [[0, -7], [7, 0], [0, 7], [-7, 0]],
  unvisited: [[-5.5, -5.5], [5.5, -5.5], [5.5, 5.5], [-5.5, 5.5]],
  old: [[0, -7], [7, 5.5], [-7, 5.5]],
};

export const KINDS = Object.keys(SHAPES) as Kind[];

/** Corners of a kind's mark around its place, pixels, y down. */
export function markOf(kind: Kind): string {
  return SHAPES[kind].map((corner) => corner.join(",")).join(" ");
}

/** Where the robot may go next when it explores. */
export function placesOverlay(pen: Pen): void {
  for (const { kind, x_m, y_m } of robot.state.value?.autopilot?.places ?? []) {
    const [x, y] = pen.at({ x: x_m, y: y_m });
    pen.context.beginPath();
    for (const [dx, dy] of SHAPES[kind]) pen.context.lineTo(x + dx, y + dy);
    pen.context.closePath();
    strokeWithHalo(pen, pen.inks[kind], 2);
  }
}
