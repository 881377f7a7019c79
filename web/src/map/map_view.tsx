// SPDX-License-Identifier: MIT
import "leaflet/dist/leaflet.css";
import "./map.css";
import { useEffect, useRef } from "preact/hooks";
import { PilotPanel } from "../pilot/pilot_panel";
import { strings } from "../strings";
import { draft, putDraft, resetGoal, sendDraft } from "./tools";
import { GoalPanel } from "./goal_panel";
import { Legend, MeasurePanel, ScaleBar } from "./legend";
import { mapModel } from "./map_model";
import { NotesNotice, OutlinePanel, PickedPanel, RemovedPanel } from "./notes_panels";
import { Scene } from "./scene";
import { Toolbar } from "./toolbar";

/** The one on the page; null before the robot has told of its map. */
let scene: Scene | null = null;

/** The live map, with what can be done on it. */
export function MapView({ shown }: { shown: boolean }) {
  const element = useRef<HTMLDivElement>(null);
  const cellSize_m = mapModel.cellSize_m.value;

  useEffect(() => (shown ? mapModel.use() : undefined), [shown]);
  useEffect(() => {
    if (cellSize_m === 0 || !element.current) return;
    const made = (scene = new Scene(element.current, cellSize_m));
    const sizes = new ResizeObserver(() => made.resize());
    sizes.observe(element.current);
    return () => {
      sizes.disconnect();
      made.end();
      scene = null;
    };
  }, [cellSize_m]);
  useEffect(() => scene?.show(shown), [shown, cellSize_m]);

  return (
    <section class="view map-view" hidden={!shown} aria-label={strings.views.map}>
      <div ref={element} class="map" />
      {cellSize_m === 0 && <p class="map-waiting">{strings.map.waiting}</p>}
      <Toolbar centre={centre} zoomBy={zoomBy} />
      <div class="map-foot">
        <NotesNotice />
        <RemovedPanel />
        <PickedPanel />
        <OutlinePanel />
        <GoalPanel />
        <MeasurePanel />
        <Legend />
        <ScaleBar />
        {shown && <PilotPanel />}
      </div>
    </section>
  );
}

/** Sets a destination in the middle of what is shown; when there is one already that was not sent yet, sends it. */
export function setGoalAtCentre(): void {
  if (draft.value) void sendDraft();
  else if (scene) putDraft(scene.middle);
}

/** Moves the map by so many pixels to the right and down. */
export function pan(dx: number, dy: number): void {
  scene?.pan(dx, dy);
}

export function zoomBy(steps: number): void {
  scene?.zoomBy(steps);
}

/** Moves the map to the robot. */
export function centre(): void {
  scene?.centre();
}

export { resetGoal };
