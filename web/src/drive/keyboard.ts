// SPDX-License-Identifier: MIT
import type { Stick } from "./stick";

const WAYS: Record<string, Stick> = {
  ArrowUp: { ahead: 1, left: 0 },
  KeyW: { ahead: 1, left: 0 },
  ArrowDown: { ahead: -1, left: 0 },
  KeyS: { ahead: -1, left: 0 },
  ArrowLeft: { ahead: 0, left: 1 },
  KeyA: { ahead: 0, left: 1 },
  ArrowRight: { ahead: 0, left: -1 },
  KeyD: { ahead: 0, left: -1 },
};
/** Turning at full speed with a key leaves nothing for a small correction. */
const TURN_SHARE = 0.8;

/** Where the keys that are down push, by their places on the keyboard. Pure. */
export function stickOf(down: ReadonlySet<string>): Stick {
  let ahead = 0;
  let left = 0;
  for (const code of down) {
    ahead += WAYS[code]?.ahead ?? 0;
    left += WAYS[code]?.left ?? 0;
  }
  const clamp = (share: number) => Math.max(-1, Math.min(1, share));
  return { ahead: clamp(ahead), left: TURN_SHARE * clamp(left) };
}

export interface KeyboardActions {
  /** False where one reads: there the arrows scroll. */
  maySteer: () => boolean;
  steer: (stick: Stick) => void;
  stop: () => void;
  changePower: (steps: number) => void;
  switchView: () => void;
}

/** True where keys are for typing or moving about in something. */
function isForOthers(event: KeyboardEvent): boolean {
  if (event.ctrlKey || event.metaKey || event.altKey) return true;
  const target = event.target;
  if (!(target instanceof HTMLElement)) return false;
  // A slider has no use for the space bar, so there too it stops the robot.
  if (event.code === "Space" && target instanceof HTMLInputElement && target.type === "range") return false;
  return target.isContentEditable || /^(INPUT|SELECT|TEXTAREA)$/.test(target.tagName);
}

/** Arrows and WASD steer, space stops, + and - set the power limit, M goes to the map and back. */
export function watchKeyboard(actions: KeyboardActions): void {
  const down = new Set<string>();
  const steer = () => actions.steer(stickOf(down));
  const acts: Record<string, () => void> = {
    Space: actions.stop,
    Equal: () => actions.changePower(1),
    NumpadAdd: () => actions.changePower(1),
    Minus: () => actions.changePower(-1),
    NumpadSubtract: () => actions.changePower(-1),
    KeyM: actions.switchView,
  };
  const forget = () => {
    down.clear();
    steer();
  };
  window.addEventListener("keydown", (event) => {
    if (isForOthers(event)) return forget(); // a Mac tells of no key that comes up while Cmd is down
    if (!(event.code in WAYS) && !(event.code in acts)) return;
    if (event.code in WAYS && !actions.maySteer()) return;
    // Space on a button that has the focus would press it as well: STOP comes first.
    event.preventDefault();
    if (event.repeat) return;
    if (event.code in WAYS) {
      down.add(event.code);
      steer();
    } else {
      acts[event.code]?.();
    }
  });
  window.addEventListener("keyup", (event) => {
    if (down.delete(event.code)) steer();
  });
  // A key that comes up while another window or a menu has the focus is never heard of.
  window.addEventListener("blur", forget);
  window.addEventListener("contextmenu", forget);
  document.addEventListener("visibilitychange", forget);
}
