// SPDX-License-Identifier: MIT
import { robot } from "../robot";
import { strings } from "../strings";

/** On pressing, not on letting go: who wants to stop does not wait. */
export function StopButton() {
  return (
    <button
      type="button"
      class="stop"
      title={strings.stopTitle}
      onPointerDown={() => robot.stop()}
      onClick={(event) => event.detail === 0 && robot.stop() /* by keyboard or by a screen reader */}
    >
      {strings.stop}
    </button>
  );
}
