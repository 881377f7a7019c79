// SPDX-License-Identifier: MIT
import { useSignal } from "@preact/signals";
import { robot } from "../robot";
import { strings } from "../strings";
import { Icon } from "../ui/icons";
import { NameForm } from "./name_form";
import { giveOrder } from "../pilot/orders";
import { addPlace, notes } from "./notes";
import { draft, dropDraft, maySend, picked, resetGoal, sendDraft, tool } from "./tools";

const TURN_RAD = Math.PI / 12;

/** A destination to be sent, or the one that was. */
export function GoalPanel() {
  if (!maySend.value) return null;
  if (draft.value) return <DraftPanel />;
  const pilot = robot.state.value?.autopilot;
  if (tool.value === "goal" && (!pilot?.goal || pilot.mode === "explore")) return <p class="map-panel">{strings.map.tapGoal}</p>;
  // Where it explores it chooses itself.
  if (pilot?.mode === "explore" && pilot.phase === "active")
    return <button type="button" class="map-reset" onClick={() => void giveOrder("navigate")}>{strings.map.endExploring}</button>;
  if (!pilot?.goal || pilot.mode === "explore") return null;
  return <button type="button" class="map-reset" onClick={resetGoal}>{strings.map.resetGoal}</button>;
}

function DraftPanel() {
  const isNaming = useSignal(false);
  if (isNaming.value) return <NameForm label={strings.map.placeName} taken={notes.value?.places.map(({ name }) => name)} onName={keep} onCancel={() => (isNaming.value = false)} />;
  return (
    <div class="map-panel" role="group" aria-label={strings.map.goalPin}>
      <button type="button" class="primary" onClick={() => void sendDraft()}>{strings.map.driveThere}</button>
      <button type="button" class="map-tool" aria-label={strings.map.turnLeft} title={strings.map.turnLeft} onClick={() => turn(TURN_RAD)}><Icon name="turnLeft" /></button>
      <button type="button" class="map-tool" aria-label={strings.map.turnRight} title={strings.map.turnRight} onClick={() => turn(-TURN_RAD)}><Icon name="turnRight" /></button>
      <button type="button" onClick={() => (isNaming.value = true)}>{strings.map.keepPlace}</button>
      <button type="button" onClick={dropDraft}>{strings.map.cancel}</button>
    </div>
  );
}

/** Gives the place a name instead. */
async function keep(name: string): Promise<boolean> {
  const goal = draft.value;
  if (!goal) return false;
  const isDone = await addPlace(name, { x_m: goal.x, y_m: goal.y, yaw_rad: goal.yaw_rad });
  if (isDone) {
    dropDraft();
    picked.value = { kind: "place", name };
  }
  return isDone;
}

function turn(by_rad: number): void {
  const goal = draft.value;
  if (!goal) return;
  const yaw_rad = (goal.yaw_rad ?? 0) + by_rad;
  draft.value = { ...goal, yaw_rad: Math.atan2(Math.sin(yaw_rad), Math.cos(yaw_rad)) };
}
