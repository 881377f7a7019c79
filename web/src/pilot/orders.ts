// SPDX-License-Identifier: MIT
/** What people order of the autopilot; what comes of it is in the robot's state. Each says whether the order was taken. */
import type { Goal } from "../link/types";
import { robot } from "../robot";

export type Mode = "manual" | "navigate" | "explore" | "home";

export const giveOrder = (mode: Mode): Promise<boolean> => robot.asked("POST", "api/v1/mode", { mode });

/** Visits them one after the other, again and again. */
export const patrol = (places: readonly string[]): Promise<boolean> => robot.asked("POST", "api/v1/mode", { mode: "patrol", places });

export const goTo = ({ x_m, y_m, yaw_rad, name }: Goal): Promise<boolean> =>
  robot.asked("POST", "api/v1/goal", { x_m, y_m, ...(yaw_rad === undefined ? {} : { yaw_rad }), ...(name === undefined ? {} : { name }) });
