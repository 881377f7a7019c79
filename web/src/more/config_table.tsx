// SPDX-License-Identifier: MIT
import { useId, useState } from "preact/hooks";
import { strings } from "../strings";
import { useAsked } from "./asking";
import { Breakable, Part, Trouble } from "./parts";

type Value = number | string | boolean | unknown[];
type Config = Record<string, Record<string, Value>>;

function valueText(value: Value): string {
  if (typeof value === "boolean") return value ? strings.more.settings.yes : strings.more.settings.no;
  const text = Array.isArray(value) ? value.map(String).join(", ") : String(value);
  return text === "" ? strings.more.settings.nothing : text;
}

/** What the program was started with; for looking only. */
export function ConfigTable() {
  const words = strings.more.settings;
  const id = useId();
  const { value, trouble } = useAsked<Config>("api/v1/config");
  const [search, setSearch] = useState("");
  const all = Object.entries(value ?? {}).flatMap(([part, table]) => Object.entries(table).map(([key, v]) => [`${part}.${key}`, valueText(v)] as const));
  const wanted = search.trim().toLowerCase();
  const found = all.filter(([key, text]) => key.includes(wanted) || text.toLowerCase().includes(wanted));
  return (
    <Part title={words.config}>
      <p class="note">{words.configHow}</p>
      <Trouble text={trouble} />
      {value && (
        <>
          <div class="field">
            <label for={id}>{words.search}</label>
            <input id={id} type="search" value={search} autocomplete="off" onInput={(event) => setSearch(event.currentTarget.value)} />
          </div>
          <p class="small" role="status">{words.found(found.length, all.length)}</p>
          {found.length > 0 && <Table rows={found} />}
        </>
      )}
    </Part>
  );
}

function Table({ rows }: { rows: (readonly [string, string])[] }) {
  const words = strings.more.settings;
  return (
    <table>
      <thead><tr><th scope="col">{words.setting}</th><th scope="col" class="number">{words.value}</th></tr></thead>
      <tbody>
        {rows.map(([key, text]) => <tr key={key}><th scope="row"><code><Breakable text={key} /></code></th><td class="number">{text}</td></tr>)}
      </tbody>
    </table>
  );
}
