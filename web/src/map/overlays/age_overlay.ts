// SPDX-License-Identifier: MIT
import { CHUNK_SIDE } from "../../link/wire";
import { robot } from "../../robot";
import { AGE_STEPS_S, ageStep } from "../geometry";
import { mapModel } from "../map_model";
import { hatch, type Pen } from "./pen";

/** How dark each step is; the last is hatched as well. */
export const AGE_SHADES = [0, 0.18, 0.36, 0.5] as const;
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
  hatch(pen, squares[AGE_STEPS_S.length]!, inks.age, 0.55);
}
