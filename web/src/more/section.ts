// SPDX-License-Identifier: MIT
import { signal } from "@preact/signals";

export const SECTIONS = ["health", "recordings", "maps", "people", "settings", "log", "about"] as const;
export type Section = (typeof SECTIONS)[number];

function sectionInAddress(): Section | null {
  return SECTIONS.find((name) => location.hash === `#more/${name}`) ?? null;
}

/** Which part of More is looked at; null: the list of them. */
export const section = signal<Section | null>(sectionInAddress());
window.addEventListener("hashchange", () => (section.value = sectionInAddress()));

export const addressOf = (name: Section) => `#more/${name}`;

const roomy = window.matchMedia("(min-width: 760px)");
/** Whether the list and a section have room beside each other. */
export const isRoomy = signal(roomy.matches);
roomy.addEventListener("change", () => (isRoomy.value = roomy.matches));
