// SPDX-License-Identifier: MIT
import { useEffect, useId, useState } from "preact/hooks";
import type { Settings } from "../link/types";
import { robot } from "../robot";
import { strings } from "../strings";
import { tell } from "../ui/notices";
import { may, useAsked } from "./asking";
import { ConfigTable } from "./config_table";
import { Part, Slider, Trouble } from "./parts";

export function SettingsSection() {
  return (
    <>
      <PowerLimit />
      <WhileRunning />
      <ConfigTable />
    </>
  );
}

/** Whether it was done, which is told; when it was not, the robot's words are shown. */
async function set(method: "POST" | "PATCH", path: string, body: unknown): Promise<boolean> {
  const isDone = await robot.asked(method, path, body);
  if (isDone) tell(strings.more.settings.done);
  return isDone;
}

function PowerLimit() {
  const words = strings.more.settings;
  const limit = robot.state.value?.power_limit;
  if (limit === undefined) return null;
  const percent = (value: number) => `${Math.round(value)} %`;
  return (
    <Part title={words.driving}>
      {may("driver") ? (
        <Slider label={words.powerLimit} value={Math.round(100 * limit)} min={0} max={100} step={5} text={percent} onSet={(value) => set("POST", "api/v1/power_limit", { power_limit: value / 100 })} />
      ) : <p>{`${words.powerLimit}: ${percent(100 * limit)}`}</p>}
      <p class="note">{words.powerLimitWhat}</p>
    </Part>
  );
}

function WhileRunning() {
  const words = strings.more.settings;
  const { value, trouble, again } = useAsked<Settings>("api/v1/settings", 5000);
  const change = async (some: Partial<Settings>) => {
    const isDone = await set("PATCH", "api/v1/settings", some);
    again();
    return isDone;
  };
  return (
    <Part title={words.running}>
      <Trouble text={trouble} />
      {value && (may("admin") ? <AdminSettings settings={value} onChange={change} /> : <ReadSettings settings={value} />)}
      {value && <p class="note">{words.untilEnd}</p>}
    </Part>
  );
}

const metres = (value: number) => `${value.toFixed(1)} m`;

function ReadSettings({ settings }: { settings: Settings }) {
  const words = strings.more.settings;
  return (
    <dl class="facts">
      <div><dt>{words.name}</dt><dd>{settings.name}</dd></div>
      <div><dt>{words.rayLength}</dt><dd>{metres(settings.trusted_range_m)}</dd></div>
    </dl>
  );
}

function AdminSettings({ settings, onChange }: { settings: Settings; onChange: (some: Partial<Settings>) => Promise<boolean> }) {
  const words = strings.more.settings;
  return (
    <>
      <NameForm name={settings.name} onSave={(name) => void onChange({ name })} />
      <Slider label={words.rayLength} value={settings.trusted_range_m} min={0.5} max={settings.trusted_range_most_m} step={0.5} text={metres} onSet={(trusted_range_m) => onChange({ trusted_range_m })} />
      <p class="note">{words.rayLengthWhat}</p>
    </>
  );
}

function NameForm({ name, onSave }: { name: string; onSave: (name: string) => void }) {
  const words = strings.more.settings;
  const id = useId();
  const [text, setText] = useState(name);
  useEffect(() => setText(name), [name]);
  const save = (event: Event) => {
    event.preventDefault();
    onSave(text.trim());
  };
  return (
    <form class="row" onSubmit={save}>
      <div class="field">
        <label for={id}>{words.name}</label>
        <input id={id} value={text} required maxLength={40} autocomplete="off" onInput={(event) => setText(event.currentTarget.value)} />
      </div>
      <button type="submit" disabled={text.trim() === name || text.trim() === ""}>{words.save}</button>
    </form>
  );
}
