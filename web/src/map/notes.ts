// SPDX-License-Identifier: MIT
/** What people drew on the map: places with a name, areas that the robot keeps out of, its home. */
import { computed, effect, signal } from "@preact/signals";
import { ask } from "../link/http";
import type { NamedPlace, Notes } from "../link/types";
import { robot } from "../robot";
import type { Point } from "./geometry";

/** As the robot has them; null before it has told. */
export const notes = signal<Notes | null>(null);

const version = computed(() => (robot.phase.value === "up" ? `${robot.state.value?.map_id} ${robot.state.value?.notes_version}` : null));

/** Asks again whenever somebody has drawn. Once, when the page begins. */
export function followNotes(): void {
  effect(() => {
    if (version.value !== null) void look();
  });
}

async function look(): Promise<void> {
  try {
    notes.value = await ask<Notes>("GET", "api/v1/notes");
  } catch {
    // The next change, or the next connection, asks again.
  }
}

const pathOf = (kind: "places" | "areas", name: string) => `api/v1/notes/${kind}/${encodeURIComponent(name)}`;
type Spot = Omit<NamedPlace, "name">;

/** Whether it was done; why not is shown. */
async function changed(method: "PUT" | "PATCH" | "DELETE", path: string, body?: unknown): Promise<boolean> {
  const isDone = await robot.asked(method, path, body);
  await look();
  return isDone;
}

export const putPlace = (name: string, { x_m, y_m, yaw_rad }: Spot) => changed("PUT", pathOf("places", name), { x_m, y_m, ...(yaw_rad === undefined ? {} : { yaw_rad }) });
export const renamePlace = (name: string, newName: string) => changed("PATCH", pathOf("places", name), { name: newName });
export const removePlace = (name: string) => changed("DELETE", pathOf("places", name));
export const putArea = (name: string, corners: readonly Point[]) => changed("PUT", pathOf("areas", name), { corners: corners.map(({ x, y }) => [x, y]) });
export const removeArea = (name: string) => changed("DELETE", pathOf("areas", name));
export const putHome = (home: NamedPlace) => changed("PUT", "api/v1/notes/home", home);
export const removeHome = () => changed("DELETE", "api/v1/notes/home");
export const dismissNotice = () => changed("DELETE", "api/v1/notes/notice");
