// SPDX-License-Identifier: MIT
import "./pilot.css";
import { NameForm } from "../map/name_form";
import { addPlace, notes } from "../map/notes";
import { maySend } from "../map/tools";
import { robot } from "../robot";
import { strings } from "../strings";
import { Icon } from "../ui/icons";
import { giveOrder, type Mode } from "./orders";
import { isPilotOpen, page, type Page, togglePilot } from "./pages";
import { PatrolChoice } from "./patrol_choice";
import { PlaceList } from "./place_list";
import { pilotWords } from "./words";

const words = strings.pilot;

const lamp = () => robot.state.value?.autopilot?.phase ?? "off";

/** How it stands with the autopilot, and what can be ordered of it. */
export function PilotPanel() {
  const { what, left, why } = pilotWords(robot.state.value?.autopilot);
  return (
    <section class="pilot" aria-label={words.title}>
      <button type="button" class="pilot-head" aria-expanded={isPilotOpen.value} onClick={togglePilot}>
        <span class={`pilot-lamp pilot-${lamp()}`}><Icon name="autopilot" /></span>
        <span class="pilot-what">{what}</span>
        <span class="pilot-left">{left}</span>
        <Icon name={isPilotOpen.value ? "down" : "up"} />
      </button>
      {why && <p class="pilot-why" role="status">{why}</p>}
      {isPilotOpen.value && <div class="pilot-page">{pageOf(page.value)}</div>}
    </section>
  );
}

function pageOf(shown: Page) {
  if (shown === "patrol") return <PatrolChoice back={back} />;
  if (shown === "places") return <PlaceList back={back} />;
  if (shown === "here") return <NameForm label={words.hereName} taken={notes.value?.places.map(({ name }) => name)} onName={saveHere} onCancel={back} />;
  return <Orders />;
}

const back = () => (page.value = "orders");

/** Where the robot is now, and where it looks. */
async function saveHere(name: string): Promise<boolean> {
  const pose = robot.state.peek()?.pose;
  const isDone = pose ? await addPlace(name, { x_m: pose.x_m, y_m: pose.y_m, yaw_rad: pose.yaw_rad }) : false;
  if (isDone) page.value = "places";
  return isDone;
}

function Orders() {
  const pilot = robot.state.value?.autopilot ?? null;
  const may = maySend.value;
  const order = (mode: Mode, text: string, isOn: boolean) => (
    <button type="button" aria-pressed={isOn} disabled={!may} onClick={() => void giveOrder(mode)}>{text}</button>
  );
  const isOnItsWay = pilot?.phase === "active";
  return (
    <>
      <div class="pilot-orders">
        {order("explore", words.explore, isOnItsWay && pilot?.mode === "explore")}
        {order("home", words.home, false)}
        <button type="button" disabled={!may} onClick={() => (page.value = "patrol")}>{words.patrol}</button>
        <button type="button" onClick={() => (page.value = "places")}>{words.places}</button>
        {order("navigate", words.standBy, pilot?.phase === "idle")}
        {order("manual", words.byHand, pilot === null)}
      </div>
      {!may && <p class="note">{words.viewer}</p>}
    </>
  );
}

/** Opens the panel where it is not always shown. */
export function PilotButton() {
  const { what } = pilotWords(robot.state.value?.autopilot);
  return (
    <button type="button" class={`pilot-button pilot-${lamp()}`} aria-expanded={isPilotOpen.value} aria-label={`${words.title}: ${what}`} title={words.title} onClick={togglePilot}>
      <Icon name="autopilot" />
    </button>
  );
}
