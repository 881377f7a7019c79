// SPDX-License-Identifier: MIT
import { useEffect, useState } from "preact/hooks";
import type { Role } from "../link/types";
import { strings } from "../strings";
import { answerTo } from "./asking";
import { clockText } from "./format";
import { Choice, CopyButton } from "./parts";
import { QrCode } from "./qr_code";

interface Invited {
  code: string;
  role: Role;
  ends_ms: number; // by performance.now()
}

export const roleOptions = (): [Role, string][] => [
  ["viewer", strings.more.people.roles.viewer],
  ["driver", strings.more.people.roles.driver],
  ["admin", strings.more.people.roles.admin],
];

/** Another device does not get here by an address that means "this machine". */
const isOnlyHere = (host: string) => host === "localhost" || host.endsWith(".localhost") || /^127\./.test(host) || host === "[::1]";

/** Makes a code that lets somebody in. */
export function Invitation() {
  const words = strings.more.people;
  const [role, setRole] = useState<Role>("driver");
  const [invited, setInvited] = useState<Invited | null>(null);
  const invite = async () => {
    const answer = await answerTo<{ code: string; role: Role; expires_in_s: number }>("POST", "api/v1/invitations", { role });
    if (answer) setInvited({ code: answer.code, role: answer.role, ends_ms: performance.now() + 1000 * answer.expires_in_s });
  };
  return (
    <>
      <div class="row">
        <Choice label={words.role} value={role} options={roleOptions()} onChoose={setRole} />
        <button type="button" class="primary" onClick={() => void invite()}>{words.makeCode}</button>
      </div>
      {invited && <Code key={invited.code} invited={invited} onEnd={() => setInvited(null)} />}
    </>
  );
}

function Code({ invited, onEnd }: { invited: Invited; onEnd: () => void }) {
  const words = strings.more.people;
  const [left_s, setLeft] = useState(() => (invited.ends_ms - performance.now()) / 1000);
  useEffect(() => {
    const timer = setInterval(() => setLeft((invited.ends_ms - performance.now()) / 1000), 1000);
    return () => clearInterval(timer);
  }, [invited]);
  if (left_s <= 0) return <p class="note" role="status">{words.expired}</p>;
  const link = `${location.origin}/#pair=${invited.code}`;
  const isLocal = isOnlyHere(location.hostname);
  return (
    <div class="invited">
      {!isLocal && <QrCode text={link} label={words.qr} />}
      <div class="invited-text">
        <p role="status">{words.codeFor[invited.role]}</p>
        <p class="code">{invited.code}</p>
        <p>{words.lasts(clockText(left_s))}</p>
        <p class="note">{isLocal ? words.localhost(location.port) : words.howToUse(location.origin)}</p>
        <div class="buttons">
          {!isLocal && <CopyButton label={words.copyLink} text={() => link} />}
          <button type="button" onClick={onEnd}>{strings.close}</button>
        </div>
      </div>
    </div>
  );
}
