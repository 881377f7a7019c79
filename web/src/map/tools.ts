// SPDX-License-Identifier: MIT
import { computed, signal } from "@preact/signals";
import { robot } from "../robot";
import type { Point } from "./geometry";

/** What a tap on the map does. */
export type Tool = "look" | "measure" | "goal";
export const tool = signal<Tool>("look");

/** Whether the map keeps the robot in sight. */
export const follows = signal(true);

/** The points between which is measured. */
export const measured = signal<Point[]>([]);

/** A destination that nobody has sent the robot to yet; without `yaw_rad` it may look anywhere then. */
export interface Draft extends Point {
  yaw_rad?: number;
}
export const draft = signal<Draft | null>(null);

export const maySend = computed(() => {
  const role = robot.me.value?.role;
  return role === "driver" || role === "admin";
});

/** Takes a tool, or puts it down when it is in the hand. */
export function takeTool(wanted: Tool): void {
  tool.value = tool.value === wanted ? "look" : wanted;
  measured.value = [];
  if (tool.value !== "goal") draft.value = null;
}

/** A tap at a place, or what stands for one. */
export function useToolAt(place: Point): void {
  if (tool.value === "measure") measured.value = [...measured.value, place];
  else if (tool.value === "goal") putDraft(place);
}

export function putDraft(place: Point): void {
  if (maySend.value) draft.value = place;
}

export async function sendDraft(): Promise<void> {
  const goal = draft.value;
  if (!goal) return;
  const { x, y, yaw_rad } = goal;
  const sent = await robot.asked("POST", "api/v1/goal", { x_m: x, y_m: y, ...(yaw_rad === undefined ? {} : { yaw_rad }) });
  if (sent && draft.value === goal) dropDraft();
}

export function dropDraft(): void {
  draft.value = null;
  if (tool.value === "goal") tool.value = "look";
}

/** The robot forgets where it was sent. */
export function resetGoal(): void {
  dropDraft();
  if (maySend.value && robot.state.value?.autopilot?.goal) void robot.asked("POST", "api/v1/mode", { mode: "manual" });
}
