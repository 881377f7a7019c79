// SPDX-License-Identifier: MIT
import { computed, signal } from "@preact/signals";
import { videoAge_ms } from "../drive/video";
import { robot } from "../robot";
import { Icon } from "../ui/icons";
import { view } from "../ui/view";
import { indicators, type Indicator } from "./indicators";
import "./indicators.css";

const SAID_MS = 6000;

const shown = computed(() =>
  indicators({
    state: robot.state.value,
    phase: robot.phase.value,
    wheel: robot.wheel.value,
    mayDrive: robot.mayDrive,
    delay_ms: robot.delay_ms.value,
    videoAge_ms: view.value === "drive" ? videoAge_ms.value : undefined,
  }).filter((indicator) => indicator.level !== "off"),
);
/** The one whose meaning is told. */
const asked = signal<string | null>(null);
let forget = 0;

function ask(id: string): void {
  clearTimeout(forget);
  asked.value = asked.value === id ? null : id;
  forget = window.setTimeout(() => (asked.value = null), SAID_MS);
}

/** All that say something, or only those that call for somebody. */
export function IndicatorBar({ loudOnly = false }: { loudOnly?: boolean }) {
  const chips = loudOnly ? shown.value.filter(({ level }) => level === "warn" || level === "bad") : shown.value;
  const about = shown.value.find((indicator) => indicator.id === asked.value)?.about;
  return (
    <div class="indicators">
      <ul>
        {chips.map((indicator) => (
          <li key={indicator.id}>
            <Chip {...indicator} />
          </li>
        ))}
      </ul>
      <p class="indicator-about" role="status">{about}</p>
    </div>
  );
}

function Chip({ id, icon, level, text, about }: Indicator) {
  return (
    <button type="button" class={`chip chip-${level}`} data-indicator={id} title={about} aria-expanded={asked.value === id} onClick={() => ask(id)}>
      <Icon name={icon} />
      <span>{text}</span>
    </button>
  );
}
