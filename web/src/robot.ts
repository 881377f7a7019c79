// SPDX-License-Identifier: MIT
import { RobotLink } from "./link/robot_link";

/** The one robot that this page is about. */
export const robot = new RobotLink();
