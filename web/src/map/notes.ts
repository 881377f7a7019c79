// SPDX-License-Identifier: MIT
/** What people drew on the map: places with a name, areas that the robot keeps out of, its home. */
import { computed, effect, signal } from "@preact/signals";
import { ask, type Headers } from "../link/http";
import type { Goal, NamedPlace, NoGoArea, Notes } from "../link/types";
import { robot } from "../robot";
import { strings } from "../strings";
import { cornersOf } from "./drawn";
import type { Point } from "./geometry";

/** As the robot has them; null before it has told. */
export const notes = signal<Notes | null>(null);

/** What was deleted last, and how it comes back; until somebody has seen it. */
export interface Removed {
  name: string;
  map_id: string;
  undo: () => Promise<boolean>;
}
export const removed = signal<Removed | null>(null);

const AGAIN_MS = 2000;

const version = computed(() => (robot.phase.value === "up" ? `${robot.state.value?.map_id} ${robot.state.value?.notes_version}` : null));

/** Asks again whenever somebody has drawn. Once, when the page begins. */
export function followNotes(): void {
  effect(() => {
    if (version.value !== null) void look();
  });
}

let rounds = 0;

/** An answer that comes after another was asked for may be the older one. */
async function look(): Promise<void> {
  const mine = ++rounds;
  try {
    const told = await ask<Notes>("GET", "api/v1/notes");
    if (mine === rounds) notes.value = told;
  } catch {
    setTimeout(() => mine === rounds && version.peek() !== null && void look(), AGAIN_MS);
  }
}

const pathOf = (kind: "places" | "areas", name: string) => `api/v1/notes/${kind}/${encodeURIComponent(name)}`;
const HOME = "api/v1/notes/home";
type Spot = Omit<NamedPlace, "name">;

/** Whether it was done; why not is shown. */
async function changed(method: "PUT" | "PATCH" | "DELETE", path: string, body?: unknown, headers?: Headers): Promise<boolean> {
  const isDone = await robot.asked(method, path, body, headers);
  await look();
  return isDone;
}

/** Somebody else may have drawn one of that name meanwhile: it is not replaced. */
const ONLY_NEW = { "If-None-Match": "*" };

export const addPlace = (name: string, { x_m, y_m, yaw_rad }: Spot) =>
  changed("PUT", pathOf("places", name), { x_m, y_m, ...(yaw_rad === undefined ? {} : { yaw_rad }) }, ONLY_NEW);
export const addArea = (name: string, corners: readonly Point[]) =>
  changed("PUT", pathOf("areas", name), { corners: corners.map(({ x, y }) => [x, y]) }, ONLY_NEW);
export const renamePlace = (name: string, newName: string) => changed("PATCH", pathOf("places", name), { name: newName });
export const removePlace = (place: NamedPlace) => remove(pathOf("places", place.name), place.name, () => addPlace(place.name, place));
export const removeArea = (area: NoGoArea) => remove(pathOf("areas", area.name), area.name, () => addArea(area.name, cornersOf(area)));
export const putHome = (home: Goal) => changed("PUT", HOME, home);
export const removeHome = (home: Goal) => remove(HOME, strings.map.home, () => putHome(home));
export const dismissNotice = () => changed("DELETE", "api/v1/notes/notice");

async function remove(path: string, name: string, undo: () => Promise<boolean>): Promise<boolean> {
  const isDone = await changed("DELETE", path);
  if (isDone && notes.value) removed.value = { name, map_id: notes.value.map_id, undo };
  return isDone;
}
