// SPDX-License-Identifier: MIT
import { computed } from "@preact/signals";
import { robot } from "../robot";
import { strings } from "../strings";

/** A stop that only a person takes back. */
const latched = computed(() => {
  const verdict = robot.state.value?.verdict;
  return verdict?.motion === "e-stop" ? verdict.reason : null;
});

/** What stands in the way of everything: no connection, or a stop. */
export function Banner() {
  const phase = robot.phase.value;
  if (robot.isStopUnheard.value) return <p class="banner banner-bad" role="alert">{strings.link.stopUnheard}</p>;
  if (phase === "connecting") return <p class="banner banner-wait" role="status">{strings.link.connecting}</p>;
  if (phase === "lost") return <p class="banner banner-bad" role="alert">{strings.link.lost}</p>;
  if (phase === "stranger" || latched.value === null) return null;
  return (
    <div class="banner banner-bad" role="alert">
      <span>{`${strings.link.stopped}: ${latched.value}`}</span>
      {robot.mayDrive && (
        <button type="button" onClick={() => void robot.asked("POST", "api/v1/clear_stop")}>{strings.clearStop}</button>
      )}
    </div>
  );
}
