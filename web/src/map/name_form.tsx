// SPDX-License-Identifier: MIT
import { useEffect, useId, useRef, useState } from "preact/hooks";
import { strings } from "../strings";
import { isName } from "./drawn";

interface NameFormProps {
  label: string;
  first?: string;
  /** Names that others have. */
  taken?: readonly string[];
  /** Whether the robot took it. */
  onName: (name: string) => Promise<boolean>;
  onCancel: () => void;
}

/** Asks for a name. */
export function NameForm({ label, first = "", taken = [], onName, onCancel }: NameFormProps) {
  const id = useId();
  const field = useRef<HTMLInputElement>(null);
  const [name, setName] = useState(first);
  const [isBusy, setBusy] = useState(false);
  useEffect(() => field.current?.select(), []);
  const wanted = name.trim();
  const trouble = taken.includes(wanted) ? strings.map.takenName : wanted && !isName(wanted) ? strings.map.badName : "";
  const submit = async (event: Event) => {
    event.preventDefault();
    setBusy(true);
    if (!(await onName(wanted))) setBusy(false);
  };
  return (
    <form class="map-panel name-form" onSubmit={(event) => void submit(event)} onKeyDown={(event) => event.key === "Escape" && onCancel()}>
      <label for={id}>{label}</label>
      <input id={id} ref={field} value={name} maxLength={80} autocomplete="off" aria-describedby={`${id}-trouble`} aria-invalid={trouble !== ""} spellcheck={false} onInput={(event) => setName(event.currentTarget.value)} />
      <p id={`${id}-trouble`} class="name-trouble" role="status">{trouble}</p>
      <div class="buttons">
        <button type="submit" class="primary" disabled={isBusy || wanted === "" || trouble !== ""}>{strings.map.keep}</button>
        <button type="button" onClick={onCancel}>{strings.map.cancel}</button>
      </div>
    </form>
  );
}
