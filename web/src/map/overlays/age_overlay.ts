// SPDX-License-Identifier: MIT
import { CHUNK_SIDE } from "../../link/wire";
import { robot } from "../../robot";
import { AGE_STEPS_S, ageStep } from "../geometry";
import { mapModel } from "../map_model";
import type { Pen } from "./pen";

/** How dark each step is; the last is hatched as well. */
export const AGE_SHADES = [0, 0.18, 0.36, 0.5] as const;
const HATCH_PX = 8;

/** Shades the parts of the map by how long ago they changed. */
export function ageOverlay(pen: Pen): void {
  void mapModel.version.value;
  const { context, inks } = pen;
  const side_m = CHUNK_SIDE * mapModel.cellSize_m.value;
  const squares = AGE_SHADES.map(() => new Path2D());
  const now_ms = performance.now();
  for (const chunk of mapModel.chunks.values()) {
    const [left, bottom] = pen.at({ x: chunk.x * side_m, y: chunk.y * side_m });
    const [right, top] = pen.at({ x: (chunk.x + 1) * side_m, y: (chunk.y + 1) * side_m });
    if (right < 0 || left > pen.width || bottom < 0 || top > pen.height) continue;
    const step = ageStep((robot.clock.age_ms(chunk.changed_s, now_ms) ?? 0) / 1000);
    if (step > 0) squares[step]!.rect(left, top, right - left, bottom - top);
  }
  context.fillStyle = inks.age;
  AGE_SHADES.forEach((shade, step) => {
    context.globalAlpha = shade;
    if (shade > 0) context.fill(squares[step]!);
  });
  context.globalAlpha = 1;
  hatch(pen, squares[AGE_STEPS_S.length]!);
}

function hatch({ context, inks, width, height, at }: Pen, where: Path2D): void {
  context.save();
  context.clip(where);
  context.beginPath();
  // Fixed to the map, so that it does not swim when the map is moved.
  const [x, y] = at({ x: 0, y: 0 });
  const first = (((x + y) % HATCH_PX) + HATCH_PX) % HATCH_PX;
  for (let sum = first; sum < width + height; sum += HATCH_PX) {
    context.moveTo(sum, 0);
    context.lineTo(sum - height, height);
  }
  context.strokeStyle = inks.age;
  context.globalAlpha = 0.55;
  context.lineWidth = 1;
  context.stroke();
  context.restore();
}
