// SPDX-License-Identifier: MIT
import { signal } from "@preact/signals";

/** From the topmost. */
export const LAYERS = ["robot", "scan", "places", "route", "notes", "trail", "graph", "age"] as const;
export type Layer = (typeof LAYERS)[number];
type Switches = Record<Layer, boolean>;

const KEPT_AS = "dynslam.layers";
const AT_FIRST: Switches = { robot: true, trail: true, scan: true, route: true, places: true, notes: true, graph: false, age: false };

/** What is drawn over the map; kept where the browser allows it. */
export const layers = signal<Switches>({ ...AT_FIRST, ...kept() });

export function switchLayer(layer: Layer, isOn: boolean): void {
  layers.value = { ...layers.value, [layer]: isOn };
  try {
    localStorage.setItem(KEPT_AS, JSON.stringify(layers.value));
  } catch {
    // then it holds until the page is closed
  }
}

function kept(): Partial<Switches> {
  try {
    const found = JSON.parse(localStorage.getItem(KEPT_AS) ?? "{}") as Partial<Record<Layer, unknown>>;
    return Object.fromEntries(LAYERS.filter((layer) => typeof found[layer] === "boolean").map((layer) => [layer, found[layer]]));
  } catch {
    return {};
  }
}
