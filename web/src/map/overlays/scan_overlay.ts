// SPDX-License-Identifier: MIT
import { OLD_SCAN_MS } from "../../drive/radar";
import { robot } from "../../robot";
import type { Pen } from "./pen";

const DOT_PX = 2;
const NEAR_DOT_PX = 4;
const NEAR_PX = 100; // a metre

/** What the lidar sees now, from where the robot is. */
export function scanOverlay({ context, inks, at, pixelsPerMetre }: Pen): void {
  const { pose, scan } = robot.state.value ?? {};
  if (!pose || !scan || (robot.clock.age_ms(scan.t_s, performance.now()) ?? 0) > OLD_SCAN_MS) return;
  context.fillStyle = inks.scan;
  const dot_px = pixelsPerMetre < NEAR_PX ? DOT_PX : NEAR_DOT_PX;
  scan.ranges_cm.forEach((range_cm, degree) => {
    if (range_cm === 0) return;
    const angle = pose.yaw_rad + (degree * Math.PI) / 180;
    const [x, y] = at({ x: pose.x_m + 0.01 * range_cm * Math.cos(angle), y: pose.y_m + 0.01 * range_cm * Math.sin(angle) });
    context.fillRect(x - dot_px / 2, y - dot_px / 2, dot_px, dot_px);
  });
}
