// SPDX-License-Identifier: MIT
import { signal } from "@preact/signals";
import { notes } from "../map/notes";
import { strings } from "../strings";
import { patrol } from "./orders";

const words = strings.pilot;

/** Names of places, in the order of their visits. */
const chosen = signal<string[]>([]);

function choose(name: string): void {
  const others = chosen.value.filter((other) => other !== name);
  chosen.value = others.length < chosen.value.length ? others : [...others, name];
}

/** Which places are visited: each that is tapped comes after those before. */
export function PatrolChoice({ back }: { back: () => void }) {
  const names = notes.value?.places.map(({ name }) => name) ?? [];
  const order = chosen.value.filter((name) => names.includes(name));
  const start = async () => {
    if (await patrol(order)) back();
  };
  return (
    <div role="group" aria-label={words.patrol}>
      <p class="note">{names.length === 0 ? words.noPlaces : words.patrolHow}</p>
      <ul class="pilot-list">
        {names.map((name) => (
          <li key={name}>
            <button type="button" class="pilot-stop" aria-pressed={order.includes(name)} onClick={() => choose(name)}>
              <span>{name}</span>
              <b>{order.includes(name) ? order.indexOf(name) + 1 : ""}</b>
            </button>
          </li>
        ))}
      </ul>
      <div class="buttons">
        <button type="button" class="primary" disabled={order.length === 0} onClick={() => void start()}>{words.startPatrol}</button>
        <button type="button" onClick={back}>{strings.map.cancel}</button>
      </div>
    </div>
  );
}
