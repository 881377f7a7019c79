// SPDX-License-Identifier: MIT
import { effect, signal, untracked } from "@preact/signals";
import { type LatLng, type LeafletMouseEvent, Map as LeafletMap } from "leaflet";
import { robot } from "../robot";
import { ChunkLayer, crsOf, latLng, MOST_ZOOM } from "./chunk_layer";
import type { Point } from "./geometry";
import { GoalMarkers } from "./goal_markers";
import { type Layer, layers, LAYERS } from "./layers";
import { onLongPress } from "./long_press";
import { OverlayCanvas } from "./overlay_canvas";
import { ageOverlay } from "./overlays/age_overlay";
import { followGraph, graphOverlay } from "./overlays/graph_overlay";
import { measureOverlay } from "./overlays/measure_overlay";
import { notesOverlay, outlineOverlay } from "./overlays/notes_overlay";
import type { Overlay } from "./overlays/pen";
import { placesOverlay } from "./overlays/places_overlay";
import { robotOverlay } from "./overlays/robot_overlay";
import { routeOverlay } from "./overlays/route_overlay";
import { scanOverlay } from "./overlays/scan_overlay";
import { trailOverlay } from "./overlays/trail_overlay";
import { TOP_LEVEL } from "./pyramid";
import { draft, follows, outline, picked, pointOfPicked, putDraft, useToolAt } from "./tools";

/** What the first look shows from side to side, at least: a few rooms. */
const FIRST_LOOK_M = 12;
/** The robot may go this far from the middle, as a part of the screen, before the map follows. */
const SLACK = 0.12;
/** What is so near to where one taps is meant. */
const TAP_PX = 24;

const OVERLAYS: Record<Layer, Overlay> = {
  robot: robotOverlay,
  scan: scanOverlay,
  places: placesOverlay,
  route: routeOverlay,
  notes: notesOverlay,
  trail: trailOverlay,
  graph: graphOverlay,
  age: ageOverlay,
};
const FROM_LOWEST = [...LAYERS].reverse();

/** For the scale bar. */
export const pixelsPerMetre = signal(0);

/** The map on the screen: Leaflet with the cells and what is drawn over them. */
export class Scene {
  private readonly map: LeafletMap;
  private readonly cells = new ChunkLayer();
  private readonly overlays: OverlayCanvas;
  private readonly goal: GoalMarkers;
  private readonly ends: (() => void)[];
  private isShown = false;
  private stopGraph = () => {};

  constructor(element: HTMLElement, cellSize_m: number) {
    this.map = new LeafletMap(element, {
      crs: crsOf(cellSize_m),
      minZoom: -TOP_LEVEL,
      maxZoom: MOST_ZOOM,
      zoomControl: false,
      attributionControl: false,
      fadeAnimation: false,
      doubleClickZoom: false,
      tapHold: false,
      center: latLng(robotsPlace() ?? { x: 0, y: 0 }),
      zoom: firstZoom(element, cellSize_m),
    });
    this.cells.addTo(this.map);
    this.overlays = new OverlayCanvas(this.map, () => [...FROM_LOWEST.filter((layer) => layers.value[layer]).map((layer) => OVERLAYS[layer]), outlineOverlay, measureOverlay]);
    this.goal = new GoalMarkers(this.map);
    this.listen();
    this.ends = [
      onLongPress(element, (x, y) => putDraft(pointOf(this.map.mouseEventToLatLng({ clientX: x, clientY: y } as MouseEvent)))),
      effect(() => this.follow()),
      effect(() => void (picked.value && this.showPicked())),
    ];
    this.tellScale();
  }

  /** Nothing is drawn while it is not shown. */
  show(isShown: boolean): void {
    this.isShown = isShown;
    this.stopGraph();
    this.stopGraph = isShown ? followGraph() : () => {};
    if (isShown) this.map.invalidateSize({ animate: false });
    this.overlays.hold(!isShown);
    this.cells.hold(!isShown);
    if (isShown) this.follow();
    if (isShown) this.showPicked();
  }

  resize(): void {
    if (this.isShown) this.map.invalidateSize({ animate: false });
  }

  end(): void {
    for (const end of this.ends) end();
    this.stopGraph();
    this.goal.end();
    this.overlays.end();
    this.cells.end();
    this.map.remove();
  }

  get middle(): Point {
    return pointOf(this.map.getCenter());
  }

  /** Pixels to the right and down. */
  pan(dx: number, dy: number): void {
    follows.value = false;
    this.map.panBy([dx, dy], { animate: false });
  }

  zoomBy(steps: number): void {
    this.map.setZoom(this.map.getZoom() + steps);
  }

  centre(): void {
    const place = robotsPlace();
    if (place) this.map.panTo(latLng(place));
  }

  private listen(): void {
    const element = this.map.getContainer();
    this.map.on("dragstart", () => {
      follows.value = false;
      this.cells.hold(true);
    });
    this.map.on("dragend", () => this.cells.hold(!this.isShown));
    this.map.on("click", (event: LeafletMouseEvent) => useToolAt(pointOf(event.latlng), TAP_PX / pixelsPerMetre.peek()));
    this.map.on("zoomend", () => this.tellScale());
    // For who has no pointer: the arrows move the map under the cross in its middle.
    element.addEventListener("keydown", (event) => {
      if (event.target !== element) return;
      if (event.key === "Enter") useToolAt(this.middle, TAP_PX / pixelsPerMetre.peek());
      else if (event.key.startsWith("Arrow")) follows.value = false;
    });
  }

  private tellScale(): void {
    pixelsPerMetre.value = this.map.project([0, 1]).x - this.map.project([0, 0]).x;
    this.map.getContainer().classList.toggle("crisp", this.map.getZoom() > 0);
  }

  /** What was chosen by its name may be anywhere. */
  private showPicked(): void {
    const place = untracked(pointOfPicked);
    if (!place || !this.isShown || this.map.getBounds().contains(latLng(place))) return;
    follows.value = false;
    this.map.panTo(latLng(place));
  }

  /** In steps, and not with each state: a map that is always moving is hard to look at, and dear. */
  private follow(): void {
    const place = robotsPlace();
    if (!follows.value || !place || !this.isShown || draft.value || outline.value.length > 0) return;
    const size = this.map.getSize();
    const off = this.map.latLngToContainerPoint(latLng(place)).subtract(size.divideBy(2));
    if (Math.abs(off.x) > SLACK * size.x || Math.abs(off.y) > SLACK * size.y) this.map.panTo(latLng(place));
  }
}

function firstZoom({ clientWidth, clientHeight }: HTMLElement, cellSize_m: number): number {
  const side_px = Math.min(clientWidth, clientHeight) || 400;
  return Math.max(-TOP_LEVEL, Math.floor(Math.log2((side_px * cellSize_m) / FIRST_LOOK_M)));
}

function robotsPlace(): Point | null {
  const pose = robot.state.value?.pose;
  return pose ? { x: pose.x_m, y: pose.y_m } : null;
}

function pointOf({ lat, lng }: LatLng): Point {
  return { x: lng, y: lat };
}
