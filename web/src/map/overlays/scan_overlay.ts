// SPDX-License-Identifier: MIT
import { robot } from "../../robot";
import type { Pen } from "./pen";

const DOT_PX = 3;

/** What the lidar sees now, from where the robot is. */
export function scanOverlay({ context, inks, at }: Pen): void {
  const { pose, scan } = robot.state.value ?? {};
  if (!pose || !scan) return;
  context.fillStyle = inks.scan;
  scan.ranges_cm.forEach((range_cm, degree) => {
    if (range_cm === 0) return;
    const angle = pose.yaw_rad + (degree * Math.PI) / 180;
    const [x, y] = at({ x: pose.x_m + 0.01 * range_cm * Math.cos(angle), y: pose.y_m + 0.01 * range_cm * Math.sin(angle) });
    context.fillRect(x - DOT_PX / 2, y - DOT_PX / 2, DOT_PX, DOT_PX);
  });
}
