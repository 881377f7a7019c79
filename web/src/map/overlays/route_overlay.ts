// SPDX-License-Identifier: MIT
import type { Goal } from "../../link/types";
import { robot } from "../../robot";
import { strings } from "../../strings";
import { type Pen, strokeWithHalo, tracePath, write } from "./pen";

/** The way that the robot means to drive, and to where. */
export function routeOverlay(pen: Pen): void {
  const autopilot = robot.state.value?.autopilot;
  if (!autopilot) return;
  const route = autopilot.route.map(([x, y]) => ({ x: x!, y: y! }));
  pen.context.beginPath();
  tracePath(pen, route);
  strokeWithHalo(pen, pen.inks.route, 3);
  pen.context.fillStyle = pen.inks.route;
  for (const point of route.slice(1, -1)) disc(pen, ...pen.at(point), 4);
  if (autopilot.goal && autopilot.nearest) drawNearest(pen, autopilot.goal, autopilot.nearest);
  if (autopilot.goal) drawGoal(pen, autopilot.goal);
}

/** How near the robot could come, and what is missing from there. */
function drawNearest(pen: Pen, goal: Goal, nearest: readonly number[]): void {
  const { context, inks } = pen;
  const [x, y] = pen.at({ x: nearest[0]!, y: nearest[1]! });
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(...pen.at({ x: goal.x_m, y: goal.y_m }));
  context.setLineDash([3, 8]);
  strokeWithHalo(pen, inks.goal, 2.5);
  context.setLineDash([]);
  context.beginPath();
  context.rect(x - 7, y - 7, 14, 14);
  strokeWithHalo(pen, inks.goal, 3);
  write(pen, strings.map.nearest, x, y - 20, inks.goal);
}

/** A target; with a hand to where the robot will look. */
function drawGoal(pen: Pen, { x_m, y_m, yaw_rad }: Goal): void {
  const { context, inks } = pen;
  const [x, y] = pen.at({ x: x_m, y: y_m });
  context.beginPath();
  context.arc(x, y, 10, 0, 2 * Math.PI);
  if (yaw_rad !== undefined) {
    context.moveTo(x, y);
    context.lineTo(x + 22 * Math.cos(yaw_rad), y - 22 * Math.sin(yaw_rad));
  }
  strokeWithHalo(pen, inks.goal, 3);
  context.fillStyle = inks.goal;
  disc(pen, x, y, 4);
}

function disc({ context }: Pen, x: number, y: number, radius: number): void {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fill();
}
