// SPDX-License-Identifier: MIT
import { signal } from "@preact/signals";

/** What is shown of the panel besides how it stands: the orders, or what one of them needs. */
export type Page = "orders" | "patrol" | "places" | "here";
export const isPilotOpen = signal(false);
export const page = signal<Page>("orders");

export function togglePilot(): void {
  isPilotOpen.value = !isPilotOpen.value;
  page.value = "orders";
}
