// SPDX-License-Identifier: MIT
import { useLayoutEffect, useRef, useState } from "preact/hooks";
import type { LogLine } from "../link/types";
import { robot } from "../robot";
import { strings } from "../strings";
import { useAsked } from "./asking";
import { clockText } from "./format";
import { Choice, CopyButton, Trouble } from "./parts";

const LEVELS = ["debug", "info", "warn", "error", "fatal"] as const;
type Level = (typeof LEVELS)[number];
/** As near to the end as counts as being there. */
const AT_END_PX = 40;

export function LogSection() {
  const words = strings.more.log;
  const { value, at_ms, trouble } = useAsked<{ lines: LogLine[] }>("api/v1/log", 2000);
  const [least, setLeast] = useState<Level>("debug");
  const lines = value?.lines.filter((line) => LEVELS.indexOf(line.level) >= LEVELS.indexOf(least)) ?? [];
  const ages = lines.map((line) => ageOf(line, at_ms));
  const asText = () => lines.map((line, i) => `${ages[i]}\t${line.level}\t${line.text}\n`).join("");
  return (
    <>
      <div class="row">
        <Choice label={words.level} value={least} options={LEVELS.filter((level) => level !== "fatal").map((level) => [level, words.atLeast[level]])} onChoose={setLeast} />
        {lines.length > 0 && <CopyButton label={words.copyAll} text={asText} />}
      </div>
      <Trouble text={trouble} />
      {value && (lines.length === 0 ? <p class="note">{words.none}</p> : <Lines lines={lines} ages={ages} />)}
    </>
  );
}

function ageOf(line: LogLine, at_ms: number): string {
  const age_ms = robot.clock.age_ms(line.t_s, at_ms);
  return age_ms === null ? "" : strings.more.log.ago(clockText(age_ms / 1000));
}

/** Shows the end, unless who reads has scrolled away from it. */
function Lines({ lines, ages }: { lines: LogLine[]; ages: string[] }) {
  const words = strings.more.log;
  const box = useRef<HTMLDivElement>(null);
  const [follows, setFollows] = useState(true);
  const toEnd = () => {
    if (box.current) box.current.scrollTop = box.current.scrollHeight;
  };
  useLayoutEffect(() => {
    if (follows) toEnd();
  }, [lines, follows]);
  const scrolled = () => {
    const at = box.current;
    if (at) setFollows(at.scrollHeight - at.scrollTop - at.clientHeight < AT_END_PX);
  };
  return (
    <div class="log-frame">
      <div ref={box} class="log" role="region" aria-label={strings.more.sections.log} tabIndex={0} onScroll={scrolled}>
        <ol>
          {lines.map((line, i) => (
            <li key={`${line.t_s} ${i}`} class={`log-${line.level}`}>
              <span class="log-age">{ages[i]}</span>
              <span class="log-level">{words.levels[line.level]}</span>
              <span class="log-text">{line.text}</span>
            </li>
          ))}
        </ol>
      </div>
      {!follows && <button type="button" class="log-end" onClick={() => setFollows(true)}>{words.toEnd}</button>}
    </div>
  );
}
