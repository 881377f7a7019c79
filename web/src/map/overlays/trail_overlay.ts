// SPDX-License-Identifier: MIT
import { effect, signal } from "@preact/signals";
import { robot } from "../../robot";
import { mapModel } from "../map_model";
import { Trail } from "../trail";
import { type Pen, tracePath } from "./pen";

const trail = new Trail();
const added = signal(0);

// Also while another view is shown.
effect(() => {
  const pose = robot.state.value?.pose;
  if (pose && !pose.lost && trail.add({ x: pose.x_m, y: pose.y_m })) added.value = added.peek() + 1;
});
effect(() => {
  void mapModel.mapId.value;
  trail.clear();
});

export function trailOverlay(pen: Pen): void {
  void added.value;
  pen.context.beginPath();
  for (const line of trail.lines) tracePath(pen, line);
  pen.context.strokeStyle = pen.inks.trail;
  pen.context.lineJoin = "round";
  pen.context.lineWidth = 2.5;
  pen.context.stroke();
}
