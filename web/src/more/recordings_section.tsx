// SPDX-License-Identifier: MIT
import { computed } from "@preact/signals";
import type { Recording } from "../link/types";
import { robot } from "../robot";
import { strings } from "../strings";
import { may, useAsked } from "./asking";
import { clockText, countText, recordedAt, sizeText } from "./format";
import { ConfirmButton, Part, Trouble } from "./parts";

interface File {
  name: string;
  bytes: number;
}

const pathOf = (name: string) => `api/v1/recordings/${encodeURIComponent(name)}`;
/** The newest first; those whose name tells no time after them. */
const order = (a: File, b: File) => (recordedAt(b.name)?.getTime() ?? 0) - (recordedAt(a.name)?.getTime() ?? 0) || b.name.localeCompare(a.name);

/** The file that is being written. */
const written = computed(() => (robot.state.value?.recording?.active ? robot.state.value.recording.file : null));

export function RecordingsSection() {
  const words = strings.more.recordings;
  const { value, trouble, again } = useAsked<{ recordings: File[]; recording: Recording }>("api/v1/recordings", 3000);
  const files = value?.recordings.slice().sort(order) ?? [];
  const remove = async (name: string) => {
    await robot.asked("DELETE", pathOf(name));
    again();
  };
  return (
    <>
      <p class="lead">{words.what}</p>
      <Running onAsked={again} />
      <Part title={words.files}>
        <Trouble text={trouble} />
        {value && files.length === 0 && <p class="note">{words.none}</p>}
        <ul class="cards">
          {files.map((file) => <FileCard key={file.name} file={file} isWritten={written.value === file.name} onDelete={() => void remove(file.name)} />)}
        </ul>
      </Part>
    </>
  );
}

function Running({ onAsked }: { onAsked: () => void }) {
  const words = strings.more.recordings;
  const recording = robot.state.value?.recording ?? null;
  const isWanted = recording?.active === true && recording.asked_for;
  const ask = async () => {
    await robot.asked(isWanted ? "DELETE" : "POST", "api/v1/recordings");
    onAsked();
  };
  return (
    <Part title={words.now}>
      <p class="recording-state" role="status">
        <span class={`lamp ${recording?.active ? "is-on" : ""}`} aria-hidden="true" />
        {isWanted ? words.running : recording?.active ? words.ring : words.idle}
      </p>
      {recording?.active && <Progress recording={recording} />}
      {recording?.trouble && <p class="said">{words.trouble(recording.trouble)}</p>}
      {may("driver") ? <button type="button" class={isWanted ? "danger" : "primary"} onClick={() => void ask()}>{isWanted ? words.end : words.begin}</button> : <p class="note">{words.viewer}</p>}
    </Part>
  );
}

function Progress({ recording }: { recording: NonNullable<Recording> }) {
  const words = strings.more.recordings;
  return (
    <dl class="facts">
      <div><dt>{words.length}</dt><dd>{clockText(recording.seconds)}</dd></div>
      <div><dt>{words.size}</dt><dd>{sizeText(recording.bytes)}</dd></div>
      <div><dt>{words.messages}</dt><dd>{countText(recording.messages)}</dd></div>
      <div class={recording.dropped > 0 ? "bad" : undefined}><dt>{words.dropped}</dt><dd>{countText(recording.dropped)}</dd></div>
    </dl>
  );
}

function FileCard({ file, isWritten, onDelete }: { file: File; isWritten: boolean; onDelete: () => void }) {
  const words = strings.more.recordings;
  const at = recordedAt(file.name);
  return (
    <li class="card">
      <h4>{at ? at.toLocaleString() : file.name}</h4>
      <p class="small">
        {at && <><span class="breaks">{file.name}</span>{" · "}</>}
        {sizeText(file.bytes)}
        {isWritten && ` · ${words.written}`}
      </p>
      <div class="buttons">
        <a class="button" href={pathOf(file.name)} download={file.name} aria-label={`${words.download}: ${file.name}`}>{words.download}</a>
        {may("admin") && !isWritten && (
          <ConfirmButton label={words.remove} about={file.name} question={words.removeQuestion(file.name)} yes={words.remove} onYes={onDelete} />
        )}
      </div>
    </li>
  );
}
