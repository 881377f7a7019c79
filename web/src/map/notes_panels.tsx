// SPDX-License-Identifier: MIT
/** What can be done with what people drew, below the map. */
import { useState } from "preact/hooks";
import type { NamedPlace } from "../link/types";
import { ConfirmButton } from "../more/parts";
import { goTo } from "../pilot/orders";
import { strings } from "../strings";
import { Icon } from "../ui/icons";
import { freeName } from "./drawn";
import { NameForm } from "./name_form";
import { dismissNotice, notes, putArea, putHome, removeArea, removeHome, removePlace, renamePlace } from "./notes";
import { dropOutline, isClosed, maySend, outline, picked, takeTool, tool } from "./tools";

const words = strings.map;
const unpick = () => (picked.value = null);

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

/** A place or an area that was tapped. */
export function PickedPanel() {
  const { kind, name } = picked.value ?? {};
  if (kind === "place") {
    const place = notes.value?.places.find((one) => one.name === name);
    return place ? <PlacePanel key={name} place={place} /> : null;
  }
  const area = notes.value?.areas.find((one) => one.name === name);
  return kind === "area" && area ? <AreaPanel name={area.name} /> : null;
}

function PlacePanel({ place }: { place: NamedPlace }) {
  const [isNaming, setNaming] = useState(false);
  const { name } = place;
  const isHome = notes.value?.home?.name === name;
  const rename = async (newName: string) => {
    const isDone = newName === name || (await renamePlace(name, newName));
    if (isDone) picked.value = { kind: "place", name: newName };
    if (isDone) setNaming(false);
    return isDone;
  };
  if (isNaming) return <NameForm label={words.rename} first={name} onName={rename} onCancel={() => setNaming(false)} />;
  return (
    <div class="map-panel" role="group" aria-label={name}>
      <Title name={name} />
      {maySend.value && (
        <div class="buttons">
          <button type="button" class="primary" onClick={() => void goTo(place).then((sent) => sent && unpick())}>{words.driveThere}</button>
          <button type="button" onClick={() => setNaming(true)}>{words.rename}</button>
          <button type="button" aria-pressed={isHome} onClick={() => void (isHome ? removeHome() : putHome(place))}>{isHome ? words.noHome : words.makeHome}</button>
          <ConfirmButton label={words.remove} about={name} question={words.removeQuestion(name)} yes={words.remove} onYes={() => void removePlace(name).then(unpick)} />
        </div>
      )}
    </div>
  );
}

function AreaPanel({ name }: { name: string }) {
  return (
    <div class="map-panel" role="group" aria-label={name}>
      <Title name={`${name}: ${words.noGo}`} />
      {maySend.value && <ConfirmButton label={words.remove} about={name} question={words.removeQuestion(name)} yes={words.remove} onYes={() => void removeArea(name).then(unpick)} />}
    </div>
  );
}

function Title({ name }: { name: string }) {
  return (
    <div class="panel-title">
      <p>{name}</p>
      <button type="button" class="map-tool" aria-label={strings.close} title={strings.close} onClick={unpick}><Icon name="close" /></button>
    </div>
  );
}

/** While an area is being drawn. */
export function OutlinePanel() {
  if (tool.value !== "area") return null;
  const corners = outline.value;
  const done = async (name: string) => {
    const isDone = await putArea(name, corners);
    if (isDone) takeTool("area");
    return isDone;
  };
  if (isClosed.value) {
    const taken = notes.value?.areas.map(({ name }) => name) ?? [];
    return <NameForm label={words.areaName} first={freeName(taken, words.areaWord)} onName={done} onCancel={dropOutline} />;
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
