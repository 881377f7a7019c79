// SPDX-License-Identifier: MIT
import { useId, useState } from "preact/hooks";
import type { Role } from "../link/types";
import { strings } from "../strings";
import { answerTo } from "./asking";
import { roleOptions } from "./invitation";
import { Choice, CopyButton } from "./parts";

interface Token {
  name: string;
  token: string;
}

/** Makes a token for a program. The robot keeps none of it, so it is shown this once. */
export function TokenForm({ onMade }: { onMade: () => void }) {
  const words = strings.more.people;
  const id = useId();
  const [name, setName] = useState("");
  const [role, setRole] = useState<Role>("viewer");
  const [made, setMade] = useState<Token | null>(null);
  const make = async (event: Event) => {
    event.preventDefault();
    const answer = await answerTo<Token>("POST", "api/v1/tokens", { name: name.trim(), role });
    if (!answer) return;
    setMade(answer);
    setName("");
    onMade();
  };
  return (
    <>
      <p>{words.tokenWhat}</p>
      <form class="row" onSubmit={(event) => void make(event)}>
        <div class="field">
          <label for={id}>{words.tokenName}</label>
          <input id={id} value={name} maxLength={64} required autocomplete="off" onInput={(event) => setName(event.currentTarget.value)} />
        </div>
        <Choice label={words.role} value={role} options={roleOptions()} onChoose={setRole} />
        <button type="submit">{words.makeToken}</button>
      </form>
      {made && <MadeToken token={made} onEnd={() => setMade(null)} />}
    </>
  );
}

function MadeToken({ token, onEnd }: { token: Token; onEnd: () => void }) {
  const words = strings.more.people;
  const id = useId();
  return (
    <div class="made" role="group" aria-labelledby={id}>
      <label id={id} for={`${id}-text`}>{words.tokenOnce(token.name)}</label>
      <input id={`${id}-text`} class="secret" readOnly value={token.token} onFocus={(event) => event.currentTarget.select()} />
      <div class="buttons">
        <CopyButton label={strings.more.copy} text={() => token.token} />
        <button type="button" onClick={onEnd}>{words.tokenKept}</button>
      </div>
    </div>
  );
}
