// SPDX-License-Identifier: MIT
import { CENTRED, isCentred, type Stick } from "./stick";

/** Buttons of the W3C's standard mapping. */
const BUTTON = { a: 0, b: 1, x: 2, lb: 4, rb: 5, lt: 6, rt: 7, back: 8, up: 12, down: 13, left: 14, right: 15, rightStick: 11 } as const;

export type PadAction = "togglePilot" | "switchPilot" | "stop" | "lessPower" | "morePower" | "switchView" | "larger" | "smaller" | "zoomIn" | "zoomOut" | "centre";

const ACTIONS: [number, PadAction][] = [
  [BUTTON.a, "togglePilot"],
  [BUTTON.b, "switchPilot"],
  [BUTTON.x, "stop"],
  [BUTTON.lb, "lessPower"],
  [BUTTON.rb, "morePower"],
  [BUTTON.back, "switchView"],
  [BUTTON.up, "larger"],
  [BUTTON.down, "smaller"],
  [BUTTON.right, "zoomIn"],
  [BUTTON.left, "zoomOut"],
  [BUTTON.rightStick, "centre"],
];

export interface PadReading {
  stick: Stick;
  /** The other stick: right and down, -1 to 1. */
  pan: { x: number; y: number };
  pressed: Set<number>;
}

/** What is used of a Gamepad. */
export interface PadState {
  mapping: string;
  connected: boolean;
  axes: readonly number[];
  buttons: readonly { pressed: boolean; value: number }[];
}

const DRIFT = 0.12;
const steady = (value: number | undefined) => (value !== undefined && Math.abs(value) > DRIFT ? value : 0);

/** Triggers for ahead and back, the left stick steers, the right one pans (thesis, appendix B.1). Pure. */
export function readPad(pad: PadState): PadReading {
  const trigger = (button: number) => pad.buttons[button]?.value ?? 0;
  const pressed = new Set<number>();
  for (const [button] of ACTIONS) if (pad.buttons[button]?.pressed) pressed.add(button);
  return {
    stick: { ahead: steady(trigger(BUTTON.rt) - trigger(BUTTON.lt)), left: -steady(pad.axes[0]) + 0 },
    pan: { x: steady(pad.axes[2]), y: steady(pad.axes[3]) },
    pressed,
  };
}

/** What was pressed since the reading before. Pure. */
export function newPresses(now: PadReading, before: PadReading | null): PadAction[] {
  return ACTIONS.filter(([button]) => now.pressed.has(button) && before !== null && !before.pressed.has(button)).map(([, action]) => action);
}

export interface PadEvents {
  steer: (stick: Stick) => void;
  pan: (x: number, y: number) => void;
  act: (action: PadAction) => void;
}

const LOOK_EVERY_MS = 16;

/** Looks at the first standard gamepad while there is one; a gamepad that goes lets go. */
export function watchGamepad(events: PadEvents): void {
  let before: PadReading | null = null;
  let steered = CENTRED;
  let isArmed = false; // the stick was in its middle since the gamepad came, and this window had the focus
  let timer = 0;
  const steer = (stick: Stick) => {
    if (stick.ahead !== steered.ahead || stick.left !== steered.left) events.steer((steered = stick));
  };
  const look = () => {
    const pad = navigator.getGamepads().find((p) => p?.connected && p.mapping === "standard");
    if (!pad) {
      steer(CENTRED);
      before = null;
      isArmed = false;
      clearInterval(timer);
      timer = 0;
      return;
    }
    const now = readPad(pad);
    if (!document.hasFocus()) isArmed = false;
    else if (isCentred(now.stick)) isArmed = true;
    steer(isArmed ? now.stick : CENTRED);
    if (now.pan.x !== 0 || now.pan.y !== 0) events.pan(now.pan.x, now.pan.y);
    for (const action of newPresses(now, before)) events.act(action);
    before = now;
  };
  if (!("getGamepads" in navigator)) return;
  window.addEventListener("gamepadconnected", () => (timer ||= window.setInterval(look, LOOK_EVERY_MS)));
  window.addEventListener("gamepaddisconnected", look);
}

/** Shakes what the driver holds, where it can be shaken. */
export function rumble(): void {
  navigator.vibrate?.(200);
  if (!("getGamepads" in navigator)) return;
  for (const pad of navigator.getGamepads())
    void pad?.vibrationActuator?.playEffect("dual-rumble", { duration: 250, strongMagnitude: 1, weakMagnitude: 0.6 }).catch(() => {});
}
