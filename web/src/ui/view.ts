// SPDX-License-Identifier: MIT
import { signal } from "@preact/signals";

export const VIEWS = ["drive", "map", "more"] as const;
export type View = (typeof VIEWS)[number];

function viewInAddress(): View {
  return VIEWS.find((view) => location.hash === `#${view}` || location.hash.startsWith(`#${view}/`)) ?? "drive";
}

/** What is shown; kept in the address, so that back and reload do what one expects. */
export const view = signal<View>(viewInAddress());
window.addEventListener("hashchange", () => (view.value = viewInAddress()));

/** Pressed again, a view goes back to its first page. */
export function show(next: View): void {
  location.hash = next;
}

export function showNext(): void {
  show(view.value === "drive" ? "map" : "drive");
}
