// SPDX-License-Identifier: MIT
import { isSameSpot } from "../map/drawn";
import { notes } from "../map/notes";
import { maySend, picked, takeTool, type Picked } from "../map/tools";
import { robot } from "../robot";
import { strings } from "../strings";
import { show } from "../ui/view";
import { goTo } from "./orders";
import { isPilotOpen, page } from "./pages";

const words = strings.pilot;

/** On the map, with what can be done with it. */
function pick(what: Picked): void {
  takeTool("look");
  picked.value = what;
  isPilotOpen.value = false;
  show("map");
}

/** All that people drew, by name. */
export function PlaceList({ back }: { back: () => void }) {
  const { places = [], areas = [], home = null } = notes.value ?? {};
  const pose = robot.state.value?.pose;
  return (
    <div role="group" aria-label={words.places}>
      {places.length + areas.length === 0 && <p class="note">{words.noPlaces}</p>}
      <ul class="pilot-list">
        {places.map((place) => (
          <li key={`place ${place.name}`}>
            <button type="button" class="pilot-stop" onClick={() => pick({ kind: "place", name: place.name })}>{place.name}</button>
            {maySend.value && <button type="button" aria-label={`${strings.map.driveThere}: ${place.name}`} onClick={() => void goTo(place).then((sent) => sent && back())}>{words.go}</button>}
          </li>
        ))}
        {home && !places.some((place) => isSameSpot(place, home)) && (
          <li key="home">
            <button type="button" class="pilot-stop" onClick={() => pick({ kind: "home", name: "" })}>{strings.map.home}</button>
          </li>
        )}
        {areas.map(({ name }) => (
          <li key={`area ${name}`}>
            <button type="button" class="pilot-stop" onClick={() => pick({ kind: "area", name })}>{`${name}: ${strings.map.noGo}`}</button>
          </li>
        ))}
      </ul>
      <div class="buttons">
        {maySend.value && <button type="button" class="primary" disabled={!pose || pose.lost} onClick={() => (page.value = "here")}>{words.saveHere}</button>}
        <button type="button" onClick={back}>{words.back}</button>
      </div>
    </div>
  );
}
