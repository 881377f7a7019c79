// SPDX-License-Identifier: MIT
import { effect } from "@preact/signals";
import { divIcon, LayerGroup, type Map as LeafletMap, Marker, Polyline } from "leaflet";
import { strings } from "../strings";
import { latLng } from "./chunk_layer";
import { type Draft, draft } from "./tools";

const HAND_PX = 64;
const TAP_PX = 44;

/** The destination before it is sent: a pin to be dragged, and a handle on a line to where the robot shall look then. */
export class GoalMarkers {
  private readonly pin = handle("goal-pin", strings.map.goalPin);
  private readonly hand = handle("goal-hand", strings.map.goalHand);
  private readonly line = new Polyline([], { className: "goal-line", interactive: false });
  private readonly group = new LayerGroup([this.line, this.pin, this.hand]);
  private readonly stop: () => void;

  constructor(private readonly map: LeafletMap) {
    this.pin.on("drag", () => this.change({ x: this.pin.getLatLng().lng, y: this.pin.getLatLng().lat }));
    this.hand.on("drag", () => this.change({ yaw_rad: this.yawOfHand() }));
    this.hand.on("dragend", () => this.place());
    map.on("zoomend", () => this.place());
    this.stop = effect(() => this.show(draft.value));
  }

  end(): void {
    this.stop();
    this.group.remove();
  }

  private change(part: Partial<Draft>): void {
    if (draft.value) draft.value = { ...draft.value, ...part };
  }

  private show(goal: Draft | null): void {
    if (!goal) return void this.group.remove();
    this.group.addTo(this.map);
    this.place();
  }

  private place(): void {
    const goal = draft.peek();
    if (!goal) return;
    this.pin.setLatLng(latLng(goal));
    // The handle keeps its distance on the screen, whatever the zoom.
    const angle = goal.yaw_rad ?? 0;
    const from = this.map.project(latLng(goal));
    const to = this.map.unproject(from.add([HAND_PX * Math.cos(angle), -HAND_PX * Math.sin(angle)]));
    this.line.setLatLngs([latLng(goal), to]);
    this.hand.setLatLng(to);
    this.hand.getElement()?.classList.toggle("goal-hand-open", goal.yaw_rad === undefined);
  }

  private yawOfHand(): number {
    const [from, to] = [this.pin.getLatLng(), this.hand.getLatLng()];
    return Math.atan2(to.lat - from.lat, to.lng - from.lng);
  }
}

function handle(className: string, title: string): Marker {
  return new Marker([0, 0], { draggable: true, autoPan: false, title, alt: title, icon: divIcon({ className: `goal-handle ${className}`, iconSize: [TAP_PX, TAP_PX] }) });
}
