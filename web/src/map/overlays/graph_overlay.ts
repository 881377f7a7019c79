// SPDX-License-Identifier: MIT
import { effect, signal } from "@preact/signals";
import { ask } from "../../link/http";
import type { Graph } from "../../link/types";
import { robot } from "../../robot";
import { layers } from "../layers";
import { type Pen, strokeWithHalo } from "./pen";

const EVERY_MS = 5000;
const AXIS_PX = 12;

const graph = signal<Graph | null>(null);

/** Asks for the graph now and then while the layer is on and the map is shown. Gives how to end that. */
export function followGraph(): () => void {
  return effect(() => {
    if (!layers.value.graph || robot.phase.value !== "up") return;
    const look = () => void ask<Graph>("GET", "api/v1/graph").then((found) => (graph.value = found), () => (graph.value = null));
    look();
    const timer = setInterval(look, EVERY_MS);
    return () => clearInterval(timer);
  });
}

/** The origins of the local maps, and lines between those that were recognised as the same place. */
export function graphOverlay(pen: Pen): void {
  if (!graph.value) return;
  const { context, inks, at } = pen;
  const places = new Map(graph.value.local_maps.map((map) => [map.id, at({ x: map.x_m, y: map.y_m })]));
  context.beginPath();
  for (const { from, to } of graph.value.closures) {
    const [a, b] = [places.get(from), places.get(to)];
    if (!a || !b) continue;
    context.moveTo(...a);
    context.lineTo(...b);
  }
  strokeWithHalo(pen, inks.closure, 1.5);
  context.beginPath();
  for (const { id, yaw_rad } of graph.value.local_maps) {
    const [x, y] = places.get(id)!;
    const [cos, sin] = [AXIS_PX * Math.cos(yaw_rad), AXIS_PX * Math.sin(yaw_rad)];
    context.moveTo(x + cos, y - sin);
    context.lineTo(x, y);
    context.lineTo(x - sin / 2, y - cos / 2);
  }
  strokeWithHalo(pen, inks.graph, 2);
}
