// SPDX-License-Identifier: MIT
import { computed, signal } from "@preact/signals";
import { goTo, giveOrder } from "../pilot/orders";
import { isPilotOpen } from "../pilot/pages";
import { robot } from "../robot";
import { areaAt, cornersOf, MOST_CORNERS, placeAt, pointOfPlace } from "./drawn";
import { distance, middleOf, type Point } from "./geometry";
import { notes } from "./notes";

/** What a tap on the map does. */
export type Tool = "look" | "measure" | "goal" | "area";
export const tool = signal<Tool>("look");

/** Whether the map keeps the robot in sight. */
export const follows = signal(true);

/** The points between which is measured. */
export const measured = signal<Point[]>([]);

/** The corners of the area that is being drawn; `isClosed` when only its name is missing. */
export const outline = signal<Point[]>([]);
export const isClosed = signal(false);

/** What people drew and somebody tapped. */
export interface Picked {
  kind: "place" | "area" | "home";
  name: string;
}
export const picked = signal<Picked | null>(null);

/** A destination that nobody has sent the robot to yet; without `yaw_rad` it may look anywhere then. */
export interface Draft extends Point {
  yaw_rad?: number;
}
export const draft = signal<Draft | null>(null);

export const maySend = computed(() => {
  const role = robot.me.value?.role;
  return role === "driver" || role === "admin";
});

/** What is done on the map needs the room below it. */
const makeRoom = () => (isPilotOpen.value = false);

/** Takes a tool, or puts it down when it is in the hand. */
export function takeTool(wanted: Tool): void {
  tool.value = tool.value === wanted ? "look" : wanted;
  measured.value = [];
  dropOutline();
  picked.value = null;
  if (tool.value !== "goal") draft.value = null;
  if (tool.value !== "look") makeRoom();
}

/** A tap at a place, or what stands for one; what is within reach of it is meant. */
export function useToolAt(place: Point, reach_m: number): void {
  if (tool.value === "measure") measured.value = [...measured.value, place];
  else if (tool.value === "goal") putDraft(place);
  else if (tool.value === "area") addCorner(place, reach_m);
  else pickAt(place, reach_m);
}

function pickAt(point: Point, reach_m: number): void {
  // A pin stands above its place.
  const above = { x: point.x, y: point.y - reach_m / 2 };
  const { places = [], areas = [], home = null } = notes.value ?? {};
  const place = placeAt(places, above, reach_m);
  const area = areaAt(areas, point);
  if (place) picked.value = { kind: "place", name: place.name };
  else if (home && distance(pointOfPlace(home), point) <= reach_m) picked.value = { kind: "home", name: "" };
  else picked.value = area && { kind: "area", name: area.name };
  if (picked.value) makeRoom();
}

/** Where it is on the map; null when it is there no more. */
export function pointOfPicked(): Point | null {
  const { kind, name } = picked.value ?? {};
  const { places = [], areas = [], home = null } = notes.value ?? {};
  const area = kind === "area" && areas.find((one) => one.name === name);
  if (area) return middleOf(cornersOf(area));
  const place = kind === "home" ? home : kind === "place" && places.find((one) => one.name === name);
  return place ? pointOfPlace(place) : null;
}

function addCorner(corner: Point, reach_m: number): void {
  const corners = outline.value;
  if (isClosed.value) return;
  if (corners.length > 2 && distance(corners[0]!, corner) <= reach_m) isClosed.value = true;
  else if (corners.length < MOST_CORNERS) outline.value = [...corners, corner];
}

export function dropOutline(): void {
  outline.value = [];
  isClosed.value = false;
}

export function putDraft(place: Point): void {
  if (!maySend.value) return;
  picked.value = null;
  draft.value = place;
  makeRoom();
}

export async function sendDraft(): Promise<void> {
  const goal = draft.value;
  if (!goal) return;
  const { x, y, yaw_rad } = goal;
  if ((await goTo({ x_m: x, y_m: y, yaw_rad })) && draft.value === goal) dropDraft();
}

export function dropDraft(): void {
  draft.value = null;
  if (tool.value === "goal") tool.value = "look";
}

/** The robot forgets where it was sent. */
export function resetGoal(): void {
  dropDraft();
  if (maySend.value && robot.state.value?.autopilot?.goal) void giveOrder("navigate");
}
