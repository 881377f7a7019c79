// SPDX-License-Identifier: MIT
/** What can be done with what people drew, below the map. */
import { useState } from "preact/hooks";
import type { Goal, NamedPlace, NoGoArea } from "../link/types";
import { ConfirmButton } from "../more/parts";
import { goTo } from "../pilot/orders";
import { strings } from "../strings";
import { Icon } from "../ui/icons";
import { freeName, isSameSpot } from "./drawn";
import { NameForm } from "./name_form";
import { addArea, dismissNotice, notes, putHome, type Removed, removeArea, removed, removeHome, removePlace, renamePlace } from "./notes";
import { dropOutline, isClosed, maySend, outline, picked, takeTool, tool } from "./tools";

const words = strings.map;
const unpick = () => (picked.value = null);
const unpickIf = (isDone: boolean) => isDone && unpick();

/** That older drawings were set aside, until somebody has read it. */
export function NotesNotice() {
  const notice = notes.value?.notice;
  if (!notice) return null;
  return (
    <div class="map-panel notes-notice" role="status">
      <p>{notice}</p>
      {maySend.value && <button type="button" onClick={() => void dismissNotice()}>{words.understood}</button>}
    </div>
  );
}

/** What was deleted, until somebody has seen it: it may come back. */
export function RemovedPanel() {
  const last = removed.value;
  // On another map it would stand anywhere.
  if (!last || picked.value || last.map_id !== notes.value?.map_id) return null;
  const undo = async ({ undo }: Removed) => {
    if (await undo()) forget();
  };
  const forget = () => (removed.value = null);
  return (
    <div class="map-panel" role="status">
      <p>{words.removed(last.name)}</p>
      <button type="button" onClick={() => void undo(last)}>{words.undo}</button>
      <CloseButton onClick={forget} />
    </div>
  );
}

/** A place or an area that was tapped, or home. */
export function PickedPanel() {
  const { kind, name } = picked.value ?? {};
  const home = notes.value?.home;
  if (kind === "home") return home ? <HomePanel home={home} /> : null;
  if (kind === "place") {
    const place = notes.value?.places.find((one) => one.name === name);
    return place ? <PlacePanel key={name} place={place} /> : null;
  }
  const area = notes.value?.areas.find((one) => one.name === name);
  return kind === "area" && area ? <AreaPanel area={area} /> : null;
}

function PlacePanel({ place }: { place: NamedPlace }) {
  const [isNaming, setNaming] = useState(false);
  const { name } = place;
  const home = notes.value?.home;
  const isHome = isSameSpot(home, place);
  const others = notes.value?.places.filter((one) => one.name !== name).map((one) => one.name);
  const rename = async (newName: string) => {
    const isDone = newName === name || (await renamePlace(name, newName));
    if (isDone) picked.value = { kind: "place", name: newName };
    if (isDone) setNaming(false);
    return isDone;
  };
  if (isNaming) return <NameForm label={words.rename} first={name} taken={others} onName={rename} onCancel={() => setNaming(false)} />;
  return (
    <div class="map-panel" role="group" aria-label={name}>
      <Title name={name} />
      {maySend.value && (
        <div class="buttons">
          <button type="button" class="primary" onClick={() => void goTo(place).then(unpickIf)}>{words.driveThere}</button>
          <button type="button" onClick={() => setNaming(true)}>{words.rename}</button>
          <button type="button" onClick={() => void (home && isHome ? removeHome(home) : putHome(place))}>{isHome ? words.noHome : words.makeHome}</button>
          <ConfirmButton label={words.remove} about={name} question={words.removeQuestion(name)} yes={words.remove} onYes={() => void removePlace(place).then(unpickIf)} />
        </div>
      )}
    </div>
  );
}

/** That of a place that is not there any more, or has no name. */
function HomePanel({ home }: { home: Goal }) {
  return (
    <div class="map-panel" role="group" aria-label={words.home}>
      <Title name={words.home} />
      {maySend.value && (
        <div class="buttons">
          <button type="button" class="primary" onClick={() => void goTo(home).then(unpickIf)}>{words.driveThere}</button>
          <button type="button" onClick={() => void removeHome(home).then(unpickIf)}>{words.noHome}</button>
        </div>
      )}
    </div>
  );
}

function AreaPanel({ area }: { area: NoGoArea }) {
  const { name } = area;
  return (
    <div class="map-panel" role="group" aria-label={name}>
      <Title name={`${name}: ${words.noGo}`} />
      {maySend.value && <ConfirmButton label={words.remove} about={name} question={words.removeQuestion(name)} yes={words.remove} onYes={() => void removeArea(area).then(unpickIf)} />}
    </div>
  );
}

function Title({ name }: { name: string }) {
  return (
    <div class="panel-title">
      <p>{name}</p>
      <CloseButton onClick={unpick} />
    </div>
  );
}

function CloseButton({ onClick }: { onClick: () => void }) {
  return <button type="button" class="map-tool map-close" aria-label={strings.close} title={strings.close} onClick={onClick}><Icon name="close" /></button>;
}

/** While an area is being drawn. */
export function OutlinePanel() {
  if (tool.value !== "area") return null;
  const corners = outline.value;
  const done = async (name: string) => {
    const isDone = await addArea(name, corners);
    if (isDone) takeTool("area");
    return isDone;
  };
  if (isClosed.value) {
    const taken = notes.value?.areas.map(({ name }) => name) ?? [];
    return <NameForm label={words.areaName} first={freeName(taken, words.areaWord)} taken={taken} onName={done} onCancel={dropOutline} />;
  }
  const undo = () => (outline.value = corners.slice(0, -1));
  return (
    <div class="map-panel" role="group" aria-label={words.areaTool}>
      <p role="status">{corners.length < 3 ? words.tapCorners : words.corners(corners.length)}</p>
      <div class="buttons">
        <button type="button" class="primary" disabled={corners.length < 3} onClick={() => (isClosed.value = true)}>{words.closeArea}</button>
        <button type="button" disabled={corners.length === 0} onClick={undo}>{words.undo}</button>
        <button type="button" onClick={() => takeTool("area")}>{words.cancel}</button>
      </div>
    </div>
  );
}
