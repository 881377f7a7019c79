// SPDX-License-Identifier: MIT
import { useRef } from "preact/hooks";
import type { Battery, Device, Devices } from "../link/types";
import { robot } from "../robot";
import { strings } from "../strings";
import { advice, conditionOf } from "./advice";
import { useAsked } from "./asking";
import { ConditionMark } from "./condition_mark";
import { meaningOf, RisingCounters, type Counts } from "./counters";
import { ageText, countText } from "./format";
import { Breakable, Part, Trouble } from "./parts";

const ORDER = ["lidar", "imu", "motors", "camera", "pins", "wheels", "computer"];
/** Not missed where there are none. */
const RARE = ["wheels", "computer"];

export function HealthSection() {
  const { value, at_ms, trouble } = useAsked<Devices>("api/v1/devices", 2000);
  const devices = value?.devices ?? {};
  const names = Object.keys(devices).filter((name) => devices[name]!.present || !RARE.includes(name)).sort((a, b) => (ORDER.indexOf(a) + 1 || 99) - (ORDER.indexOf(b) + 1 || 99));
  return (
    <>
      <Trouble text={trouble} />
      <ul class="cards">
        {names.map((name) => <DeviceCard key={name} name={name} health={devices[name]!} at_ms={at_ms} />)}
      </ul>
      <LinkPart />
      {value && <CounterTable counts={{ ...robot.state.peek()?.counters, ...value.counters }} at_ms={at_ms} />}
    </>
  );
}

function DeviceCard({ name, health, at_ms }: { name: string; health: Device; at_ms: number }) {
  const words = strings.more.health;
  const titles: Record<string, string> = words.devices;
  // Of when the robot answered: what came since was not asked for.
  const age_ms = health.samples && health.last_sample_s !== undefined ? robot.clock.age_ms(health.last_sample_s, at_ms) : null;
  const condition = conditionOf(name, health, age_ms);
  const todo = advice(name, health, age_ms);
  return (
    <li class={`card is-${condition}`}>
      <h3>{titles[name] ?? name}</h3>
      <p class="condition">
        <ConditionMark condition={condition} />
        {words.conditions[condition]}
      </p>
      {health.about && <p class="said">{health.about}</p>}
      {health.present && (
        <dl class="facts">
          <div><dt>{words.samples}</dt><dd>{countText(health.samples ?? 0)}</dd></div>
          <div><dt>{words.errors}</dt><dd>{countText(health.errors ?? 0)}</dd></div>
          <div><dt>{words.lastSample}</dt><dd>{age_ms === null ? words.never : words.ago(ageText(age_ms))}</dd></div>
        </dl>
      )}
      {health.trouble && <p class="said">{words.said(health.trouble)}</p>}
      {todo && <p class="advice">{todo}</p>}
    </li>
  );
}

function LinkPart() {
  const words = strings.more.health;
  const delay = robot.delay_ms.value, motor = robot.motor_ms.value;
  const milliseconds = (value: number | null) => (value === null ? words.notDriving : `${value.toFixed(0)} ms`);
  return (
    <Part title={words.robot}>
      <dl class="facts">
        <BatteryFact battery={robot.state.value?.battery ?? null} />
        <div><dt>{words.delay}</dt><dd>{milliseconds(delay)}</dd></div>
        <div><dt>{words.motorDelay}</dt><dd>{milliseconds(motor)}</dd></div>
      </dl>
    </Part>
  );
}

function BatteryFact({ battery }: { battery: Battery | null }) {
  const words = strings.more.health;
  const text = battery
    ? [`${battery.voltage_v.toFixed(1)} V`, `${Math.round(100 * battery.share)} %`, words.levels[battery.level], battery.brownout && words.brownout].filter(Boolean).join(", ")
    : words.unknown;
  return <div><dt>{words.battery}</dt><dd>{text}</dd></div>;
}

function CounterTable({ counts, at_ms }: { counts: Counts; at_ms: number }) {
  const words = strings.more.health;
  const rising = useRef({ counters: new RisingCounters(), seen_ms: -1 }).current;
  if (rising.seen_ms !== at_ms) {
    rising.counters.see(counts, at_ms);
    rising.seen_ms = at_ms;
  }
  const names = Object.keys(counts).sort();
  const risen = names.filter((name) => rising.counters.hasRisen(name, at_ms)).length;
  return (
    <details class="part">
      <summary>{words.counters(names.length, risen)}</summary>
      {names.length === 0 ? <p class="note">{words.noCounters}</p> : (
        <table>
          <thead><tr><th scope="col">{words.counter}</th><th scope="col" class="number">{words.count}</th></tr></thead>
          <tbody>{names.map((name) => <CounterRow key={name} name={name} n={counts[name]!} hasRisen={rising.counters.hasRisen(name, at_ms)} />)}</tbody>
        </table>
      )}
    </details>
  );
}

function CounterRow({ name, n, hasRisen }: { name: string; n: number; hasRisen: boolean }) {
  const meaning = meaningOf(name);
  return (
    <tr class={hasRisen ? "risen" : undefined}>
      <th scope="row"><code><Breakable text={name} /></code>{meaning && <small>{meaning}</small>}</th>
      <td class="number">
        {countText(n)}
        {hasRisen && <small>{strings.more.health.rising}</small>}
      </td>
    </tr>
  );
}
