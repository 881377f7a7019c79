// SPDX-License-Identifier: MIT
import type { Twist } from "../link/types";

/** What a thumb, keys or a gamepad ask for: shares from -1 to 1, ahead and to the left. */
export interface Stick {
  ahead: number;
  left: number;
}

export interface SpeedLimits {
  speed_mps: number;
  turn_radps: number;
}

export const CENTRED: Stick = { ahead: 0, left: 0 };
const DEAD_ZONE = 0.08;
/** How much of the answer is cubic: fine near the middle, everything at the rim. */
const CUBIC = 0.6;

export const isCentred = (stick: Stick) => stick.ahead === 0 && stick.left === 0;

/** A thumb never rests exactly in the middle, and small moves are meant to be fine ones. */
export function shaped(share: number): number {
  const size = Math.min(1, Math.abs(share));
  if (!(size > DEAD_ZONE)) return 0;
  const rest = (size - DEAD_ZONE) / (1 - DEAD_ZONE);
  return Math.sign(share) * ((1 - CUBIC) * rest + CUBIC * rest ** 3);
}

export function twistOf(stick: Stick, limits: SpeedLimits): Twist {
  // Without minus zeros, which JSON would send as they are.
  return { v: shaped(stick.ahead) * limits.speed_mps + 0, w: shaped(stick.left) * limits.turn_radps + 0 };
}
