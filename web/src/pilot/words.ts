// SPDX-License-Identifier: MIT
import type { Autopilot } from "../link/types";
import { strings } from "../strings";

/** What the autopilot does, how far it has to go, and why it does not drive or what it waits for; empty where there is nothing to say. */
export interface PilotWords {
  what: string;
  left: string;
  why: string;
}

/** Pure. */
export function pilotWords(pilot: Autopilot | null | undefined): PilotWords {
  const words = strings.pilot;
  if (!pilot) return { what: words.byHand, left: "", why: "" };
  const { phase, mode, goal, reason, remaining_m } = pilot;
  if (phase === "stopped") return { what: words.stopped, left: "", why: reason || words.look };
  if (phase === "idle") return { what: words.idle, left: "", why: reason };
  // With a goal and neither a way nor a reason it was there just now: a patrol.
  const pauses = goal !== null && remaining_m === null && !reason;
  const what = mode === "explore" ? words.exploring : !goal ? words.waiting : pauses ? words.pausing(goal.name) : words.driving(goal.name);
  return { what, left: remaining_m === null ? "" : words.left(remaining_m.toFixed(1)), why: reason };
}
