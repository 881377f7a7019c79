// SPDX-License-Identifier: MIT
import { robot } from "../robot";
import { strings } from "../strings";
import { Icon } from "../ui/icons";
import { draft, dropDraft, maySend, resetGoal, sendDraft, tool } from "./tools";

const TURN_RAD = Math.PI / 12;

/** A destination to be sent, or the one that was. */
export function GoalPanel() {
  if (!maySend.value) return null;
  if (draft.value) return <DraftPanel />;
  const goal = robot.state.value?.autopilot?.goal;
  if (!goal) return tool.value === "goal" ? <p class="map-panel">{strings.map.tapGoal}</p> : null;
  return <button type="button" class="map-reset" onClick={resetGoal}>{strings.map.resetGoal}</button>;
}

function DraftPanel() {
  return (
    <div class="map-panel" role="group" aria-label={strings.map.goalPin}>
      <button type="button" class="primary" onClick={() => void sendDraft()}>{strings.map.driveThere}</button>
      <button type="button" class="map-tool" aria-label={strings.map.turnLeft} title={strings.map.turnLeft} onClick={() => turn(TURN_RAD)}><Icon name="turnLeft" /></button>
      <button type="button" class="map-tool" aria-label={strings.map.turnRight} title={strings.map.turnRight} onClick={() => turn(-TURN_RAD)}><Icon name="turnRight" /></button>
      <button type="button" onClick={dropDraft}>{strings.map.cancel}</button>
    </div>
  );
}

function turn(by_rad: number): void {
  const goal = draft.value;
  if (!goal) return;
  const yaw_rad = (goal.yaw_rad ?? 0) + by_rad;
  draft.value = { ...goal, yaw_rad: Math.atan2(Math.sin(yaw_rad), Math.cos(yaw_rad)) };
}
