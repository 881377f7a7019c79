// SPDX-License-Identifier: MIT
/** Everything that steers or is pressed, joined to the robot. */
import { effect, signal } from "@preact/signals";
import * as map from "../map/map_view";
import { giveOrder } from "../pilot/orders";
import { robot } from "../robot";
import { showNext, view } from "../ui/view";
import { rumble, watchGamepad, type PadAction } from "./gamepad";
import { watchKeyboard } from "./keyboard";
import { changePower } from "./power";
import { Steering } from "./steering";

export const steering = new Steering((twist) => robot.drive(twist));

/** Each time that the gamepad is looked at. */
const PAN_PX = 12;

export const MINIMAP_SIZES = ["small", "medium", "large"] as const;
export const minimapSize = signal(1);

function resizeMinimap(steps: number): void {
  minimapSize.value = Math.max(0, Math.min(MINIMAP_SIZES.length - 1, minimapSize.value + steps));
}

/** On or off, as it was last (thesis, appendix B.1). */
function togglePilot(): void {
  void giveOrder(robot.state.value?.autopilot ? "manual" : "explore");
}

function switchPilot(): void {
  void giveOrder(robot.state.value?.mode === "explore" ? "navigate" : "explore");
}

function act(action: PadAction): void {
  const onMap = view.value === "map";
  const acts: Record<PadAction, () => void> = {
    togglePilot: onMap ? map.setGoalAtCentre : togglePilot,
    switchPilot: onMap ? map.resetGoal : switchPilot,
    stop: () => robot.stop(),
    lessPower: () => changePower(-1),
    morePower: () => changePower(1),
    switchView: showNext,
    larger: () => resizeMinimap(1),
    smaller: () => resizeMinimap(-1),
    zoomIn: () => map.zoomBy(1),
    zoomOut: () => map.zoomBy(-1),
    centre: map.centre,
  };
  acts[action]();
}

/** Once, when the page begins. */
export function sitDown(): void {
  steering.watchAttention();
  watchKeyboard({
    maySteer: () => view.peek() !== "more",
    steer: (stick) => steering.set("keys", stick),
    stop: () => robot.stop(),
    changePower,
    switchView: showNext,
  });
  watchGamepad({ steer: (stick) => steering.set("gamepad", stick), pan: (x, y) => map.pan(-PAN_PX * x, -PAN_PX * y), act });
  // Who gets the wheel, or it back, begins from standing still.
  effect(() => {
    if (robot.wheel.value.mine) void steering.learnLimits();
    steering.release();
  });
  effect(() => {
    if (view.value === "more") steering.release();
  });
  let collided = false;
  effect(() => {
    const collides = robot.state.value?.collision === true;
    if (collides && !collided && robot.wheel.peek().mine) rumble();
    collided = collides;
  });
}
