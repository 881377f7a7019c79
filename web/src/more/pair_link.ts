// SPDX-License-Identifier: MIT
import { effect, signal } from "@preact/signals";
import { robot } from "../robot";
import { strings } from "../strings";
import { tell } from "../ui/notices";
import { codeInHash } from "./pairing_code";

/** The code of the link by which one came, until it is used. */
export const linkCode = signal<string | null>(null);

/** Out of the address at once: it is not for bookmarks, or for who looks on. */
function take(): void {
  const code = codeInHash(location.hash);
  if (code === null) return;
  history.replaceState(null, "", location.pathname + location.search);
  linkCode.value = code;
}

take();
window.addEventListener("hashchange", take);

effect(() => {
  const me = robot.me.value;
  if (linkCode.value === null || !me || me.role === "none") return;
  linkCode.value = null;
  tell(strings.pair.already(strings.more.people.roles[me.role]));
});
