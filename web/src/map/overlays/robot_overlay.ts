// SPDX-License-Identifier: MIT
import type { PoseEstimate } from "../../link/types";
import { robot } from "../../robot";
import { ellipseOf } from "../geometry";
import type { Inks } from "../look";
import type { Pen } from "./pen";

const LENGTH_M = 0.24;
const WIDTH_M = 0.2;
const LEAST_PX = 18;
const SIGMAS = 2;

/** The robot to scale, but never too small to be seen, its front to where it looks; and where it may be as well. */
export function robotOverlay(pen: Pen): void {
  const pose = robot.state.value?.pose;
  if (!pose) return;
  const [x, y] = pen.at({ x: pose.x_m, y: pose.y_m });
  drawDoubt(pen, pose, x, y);
  drawRobot(pen.context, pen.inks, pose, x, y, Math.max(LEAST_PX, LENGTH_M * pen.pixelsPerMetre));
}

export function drawRobot(context: CanvasRenderingContext2D, inks: Inks, pose: PoseEstimate, x: number, y: number, length_px: number): void {
  const front = length_px / 2;
  const side = (front * WIDTH_M) / LENGTH_M;
  context.save();
  context.translate(x, y);
  context.rotate(-pose.yaw_rad);
  context.beginPath();
  context.moveTo(front + 0.35 * length_px, 0); // a nose, so that the heading is seen at any size
  context.lineTo(front, side);
  context.lineTo(-front, side);
  context.lineTo(-front, -side);
  context.lineTo(front, -side);
  context.closePath();
  context.lineJoin = "round";
  context.lineWidth = 4;
  context.strokeStyle = inks.halo;
  context.stroke();
  context.fillStyle = pose.lost ? inks.lost : inks.robot;
  context.fill();
  context.restore();
}

function drawDoubt({ context, inks, pixelsPerMetre }: Pen, pose: PoseEstimate, x: number, y: number): void {
  // A program before this was in the contract leaves it out.
  const ellipse = (pose.covariance as PoseEstimate["covariance"] | undefined) && ellipseOf(pose.covariance, SIGMAS);
  if (!ellipse || ellipse.long_m * pixelsPerMetre < 1) return;
  context.beginPath();
  context.ellipse(x, y, ellipse.long_m * pixelsPerMetre, ellipse.short_m * pixelsPerMetre, -ellipse.turned_rad, 0, 2 * Math.PI);
  context.fillStyle = context.strokeStyle = pose.lost ? inks.lost : inks.robot;
  context.globalAlpha = 0.18;
  context.fill();
  context.globalAlpha = 0.8;
  context.lineWidth = 1.5;
  context.stroke();
  context.globalAlpha = 1;
}
