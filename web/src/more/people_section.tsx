// SPDX-License-Identifier: MIT
import type { Credential } from "../link/types";
import { robot } from "../robot";
import { strings } from "../strings";
import { tell } from "../ui/notices";
import { may, useAsked } from "./asking";
import { longAgeText } from "./format";
import { Invitation } from "./invitation";
import { ConfirmButton, Part, Trouble } from "./parts";
import { TokenForm } from "./token_form";

export function PeopleSection() {
  return (
    <>
      <WhoAmI />
      {may("admin") ? <ForAdmins /> : <p class="note">{strings.more.people.adminsOnly}</p>}
    </>
  );
}

function WhoAmI() {
  const words = strings.more.people;
  const me = robot.me.value;
  const leave = async () => {
    if (!(await robot.asked("POST", "api/v1/logout"))) return;
    await robot.meet();
    if (robot.me.value && robot.me.value.role !== "none") tell(words.stillIn);
  };
  return (
    <Part title={words.you}>
      {me && me.role !== "none" && <p>{words.youAre(me.name, words.roles[me.role])}</p>}
      <div class="buttons">
        <ConfirmButton label={words.logout} question={words.logoutQuestion} yes={words.logout} onYes={() => void leave()} />
      </div>
    </Part>
  );
}

function ForAdmins() {
  const words = strings.more.people;
  const { value, trouble, again } = useAsked<{ people: Credential[] }>("api/v1/people", 5000);
  const revoke = async (id: string) => {
    if (await robot.asked("DELETE", `api/v1/people/${encodeURIComponent(id)}`)) tell(words.revoked);
    again();
  };
  return (
    <>
      <Part title={words.invite}>
        <p>{words.inviteWhat}</p>
        <Invitation />
      </Part>
      <Part title={words.all}>
        <Trouble text={trouble} />
        {value?.people.length === 0 && <p class="note">{words.nobody}</p>}
        <ul class="cards">
          {value?.people.map((one) => <Person key={one.id} one={one} onRevoke={() => void revoke(one.id)} />)}
        </ul>
      </Part>
      <Part title={words.tokens}>
        <TokenForm onMade={again} />
      </Part>
    </>
  );
}

function Person({ one, onRevoke }: { one: Credential; onRevoke: () => void }) {
  const words = strings.more.people;
  const age = longAgeText(Date.now() / 1000 - one.last_seen);
  return (
    <li class="card">
      <h4 class="breaks">{one.name}</h4>
      <p class="small">
        {words.kinds[one.kind]} · {words.roles[one.role]} · <span title={new Date(1000 * one.last_seen).toLocaleString()}>{age ? words.seen(age) : words.seenNow}</span>
      </p>
      <div class="buttons">
        <ConfirmButton label={words.revoke} about={one.name} question={words.revokeQuestion(one.name)} yes={words.revoke} onYes={onRevoke} />
      </div>
    </li>
  );
}
