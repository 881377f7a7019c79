// SPDX-License-Identifier: MIT
import { useSignalEffect } from "@preact/signals";
import { useEffect, useId, useRef, useState } from "preact/hooks";
import { ask } from "../link/http";
import type { Me } from "../link/types";
import { robot } from "../robot";
import { strings } from "../strings";
import { show } from "../ui/view";
import { whyNot } from "./asking";
import { browserName } from "./browser_name";
import "./more.css";
import { linkCode } from "./pair_link";
import { cleanCode } from "./pairing_code";

/** Pairs this browser; why not, or null when it is. */
async function pair(typed: string, name: string): Promise<string | null> {
  const code = cleanCode(typed);
  if (code === null) return strings.pair.noCode;
  try {
    await ask<Me>("POST", "api/v1/pair", { code, name });
    // Whether the browser has kept the cookie shows only when it is asked for.
    if ((await ask<Me>("GET", "api/v1/me")).role === "none") return strings.pair.noCookies;
  } catch (error) {
    return whyNot(error);
  }
  show("drive");
  await robot.meet();
  return null;
}

/** For who is not known to the robot. */
export function PairView() {
  const words = strings.pair;
  const id = useId();
  const [code, setCode] = useState("");
  const [name, setName] = useState(() => browserName(navigator.userAgent, navigator.maxTouchPoints));
  const [error, setError] = useState<string | null>(null);
  const [isBusy, setBusy] = useState(false);
  const codeField = useRef<HTMLInputElement>(null);
  const tryCode = async (typed: string) => {
    setBusy(true);
    setError(null);
    const why = await pair(typed, name.trim());
    setBusy(false);
    setError(why);
    if (why !== null) codeField.current?.focus();
  };
  useSignalEffect(() => {
    const given = linkCode.value;
    if (given === null) return;
    linkCode.value = null;
    setCode(given);
    void tryCode(given);
  });
  useEffect(() => codeField.current?.focus(), []);
  const submit = (event: Event) => {
    event.preventDefault();
    if (!isBusy) void tryCode(code);
  };
  return (
    <main class="views">
      <section class="view pair">
        <form onSubmit={submit} aria-labelledby={`${id}-title`}>
          <h1 id={`${id}-title`}>{words.title}</h1>
          <p>{words.what}</p>
          <div class="field">
            <label for={`${id}-code`}>{words.code}</label>
            <input
              id={`${id}-code`}
              ref={codeField}
              class="code"
              value={code}
              required
              maxLength={64}
              autocomplete="one-time-code"
              autocapitalize="characters"
              spellcheck={false}
              placeholder="ABCD-2345"
              aria-describedby={`${id}-hint${error === null ? "" : ` ${id}-error`}`}
              aria-invalid={error !== null}
              onInput={(event) => setCode(event.currentTarget.value)}
            />
          </div>
          {error !== null && <p id={`${id}-error`} class="error" role="alert">{error}</p>}
          <div class="field">
            <label for={`${id}-name`}>{words.name}</label>
            <input id={`${id}-name`} value={name} required maxLength={64} autocomplete="off" onInput={(event) => setName(event.currentTarget.value)} />
          </div>
          <button type="submit" class="primary" disabled={isBusy}>{isBusy ? words.busy : words.pair}</button>
          <p id={`${id}-hint`} class="note">{words.where} <code>journalctl -u dynslam</code>. {words.orInvited}</p>
          <p class="note">{words.stopWorks}</p>
        </form>
      </section>
    </main>
  );
}
