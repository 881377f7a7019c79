// SPDX-License-Identifier: MIT
import { computed, signal } from "@preact/signals";
import { PilotButton } from "../pilot/pilot_panel";
import { robot } from "../robot";
import { strings } from "../strings";

const STEP = 0.05;
const LEAST = 0.05;
/** What was set here counts until the robot has had time to say the same. */
const OWN_FOR_MS = 600;

const own = signal<number | null>(null);
let forget = 0;

/** The power limit as this page sees it: the robot's, or what was just asked for. */
const limit = computed(() => own.value ?? robot.state.value?.power_limit ?? 1);
const applied = computed(() => {
  const power = robot.state.value?.power;
  return power ? Math.max(Math.abs(power.left), Math.abs(power.right)) : 0;
});

export function changePower(steps: number): void {
  if (!robot.mayDrive) return;
  const wanted = Math.round((limit.value + steps * STEP) / STEP) * STEP;
  const next = +Math.min(1, Math.max(LEAST, wanted)).toFixed(2);
  own.value = next;
  clearTimeout(forget);
  forget = window.setTimeout(() => (own.value = null), OWN_FOR_MS);
  void robot.asked("POST", "api/v1/power_limit", { power_limit: next });
}

const percent = (share: number) => `${Math.round(100 * share)} %`;

/** What the motors get, and how much of their power the stick can ask for at most (thesis, figure 3.2). */
export function Power() {
  const label = strings.drive.power(percent(applied.value), percent(limit.value));
  return (
    <div class="power">
      <PilotButton />
      <button type="button" aria-label={strings.drive.less} disabled={!robot.mayDrive} onClick={() => changePower(-1)}>−</button>
      <div class="power-bar" role="img" aria-label={label}>
        <div class="power-applied" style={{ transform: `scaleX(${applied.value})` }} />
        <div class="power-limit" style={{ left: percent(limit.value) }} />
        <span>{strings.drive.limit(percent(limit.value))}</span>
      </div>
      <button type="button" aria-label={strings.drive.more} disabled={!robot.mayDrive} onClick={() => changePower(1)}>+</button>
    </div>
  );
}
