// SPDX-License-Identifier: MIT
import { computed, signal } from "@preact/signals";
import { DARK, LIGHT } from "./palette";

const preference = matchMedia("(prefers-color-scheme: dark)");
const isDark = signal(preference.matches);
preference.addEventListener("change", () => (isDark.value = preference.matches));

export const palette = computed(() => (isDark.value ? DARK : LIGHT));

/** What is drawn over the map. Each has a halo of the ground's colour, to be seen on walls and floor alike. */
export interface Inks {
  halo: string;
  robot: string;
  lost: string;
  trail: string;
  scan: string;
  graph: string;
  closure: string;
  route: string;
  goal: string;
  frontier: string;
  unvisited: string;
  old: string;
  note: string;
  noGo: string;
  measure: string;
  age: string;
}

const LIGHT_INKS: Inks = {
  halo: "#ffffff",
  robot: "#0b5fc4",
  lost: "#70787d",
  trail: "#5b8fd0",
  scan: "#d0182b",
  graph: "#6a3fb5",
  closure: "#b5369b",
  route: "#0a7a43",
  goal: "#0a7a43",
  frontier: "#0a7a43",
  unvisited: "#0b5fc4",
  old: "#a85400",
  note: "#7a2a8c",
  noGo: "#b3161b",
  measure: "#8a2be2",
  age: "#6b5a3a",
};

const DARK_INKS: Inks = {
  halo: "#101417",
  robot: "#5aa9ff",
  lost: "#a0a8ad",
  trail: "#3f78b5",
  scan: "#ff5b6b",
  graph: "#b79bff",
  closure: "#ff8be0",
  route: "#54cf8b",
  goal: "#54cf8b",
  frontier: "#54cf8b",
  unvisited: "#5aa9ff",
  old: "#ffb650",
  note: "#e2a4f2",
  noGo: "#ff7b7b",
  measure: "#d7a6ff",
  age: "#000000",
};

export const inks = computed(() => (isDark.value ? DARK_INKS : LIGHT_INKS));
