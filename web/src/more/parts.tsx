// SPDX-License-Identifier: MIT
/** What several sections are built of. */
import { Fragment, type ComponentChildren } from "preact";
import { useEffect, useId, useLayoutEffect, useRef, useState } from "preact/hooks";
import { strings } from "../strings";
import { tell } from "../ui/notices";
import { copyText } from "./clipboard";

export function Part({ title, children }: { title: string; children: ComponentChildren }) {
  const id = useId();
  return (
    <section class="part" aria-labelledby={id}>
      <h3 id={id}>{title}</h3>
      {children}
    </section>
  );
}

/** Why there is nothing, or nothing newer. */
export function Trouble({ text }: { text: string | null }) {
  return text === null ? null : <p class="note" role="status">{text}</p>;
}

/** A name like `part.some_thing`, which may go on in the next line behind its dots and underscores. */
export function Breakable({ text }: { text: string }) {
  return <>{(text.match(/[^._]*[._]?/g) ?? []).map((piece, i) => <Fragment key={i}>{i > 0 && <wbr />}{piece}</Fragment>)}</>;
}

interface ConfirmProps {
  label: string;
  /** Which one, for who does not see where the button stands. */
  about?: string;
  question: string;
  yes: string;
  onYes: () => void;
}

/** A button that asks back, in its place. */
export function ConfirmButton({ label, about, question, yes, onYes }: ConfirmProps) {
  const [isOpen, setOpen] = useState(false);
  const keep = useRef<HTMLButtonElement>(null);
  const opener = useRef<HTMLButtonElement>(null);
  const wasOpen = useRef(false);
  useLayoutEffect(() => {
    if (isOpen) keep.current?.focus();
    else if (wasOpen.current) opener.current?.focus();
    wasOpen.current = isOpen;
  }, [isOpen]);
  const answer = (does: boolean) => {
    setOpen(false);
    if (does) onYes();
  };
  if (!isOpen) return <button ref={opener} type="button" class="danger" aria-label={about && `${label}: ${about}`} onClick={() => setOpen(true)}>{label}</button>;
  return (
    <div class="confirm" role="group" aria-label={question} onKeyDown={(event) => event.key === "Escape" && answer(false)}>
      <p>{question}</p>
      <div class="buttons">
        <button ref={keep} type="button" onClick={() => answer(false)}>{strings.more.cancel}</button>
        <button type="button" class="danger" onClick={() => answer(true)}>{yes}</button>
      </div>
    </div>
  );
}

export function CopyButton({ label, text }: { label: string; text: () => string }) {
  const copy = async () => tell((await copyText(text())) ? strings.more.copied : strings.more.notCopied);
  return <button type="button" onClick={() => void copy()}>{label}</button>;
}

interface SliderProps {
  label: string;
  value: number;
  min: number;
  max: number;
  step: number;
  text: (value: number) => string;
  /** When the hand lets go of it; whether the robot took it. */
  onSet: (value: number) => Promise<boolean>;
}

/** Follows the hand while it is moved, and the robot otherwise. */
export function Slider({ label, value, min, max, step, text, onSet }: SliderProps) {
  const id = useId();
  const [held, setHeld] = useState<number | null>(null);
  const shown = held ?? value;
  // What the robot says then is right, whatever was asked for.
  useEffect(() => setHeld(null), [value]);
  const set = async (wanted: number) => {
    if (!(await onSet(wanted))) setHeld(null);
  };
  return (
    <div class="slider">
      <label for={id}>{label}</label>
      <output for={id}>{text(shown)}</output>
      <input
        id={id}
        type="range"
        min={min}
        max={max}
        step={step}
        value={shown}
        aria-valuetext={text(shown)}
        onInput={(event) => setHeld(Number(event.currentTarget.value))}
        onChange={(event) => void set(Number(event.currentTarget.value))}
      />
      <span class="ends" aria-hidden="true">
        <span>{text(min)}</span>
        <span>{text(max)}</span>
      </span>
    </div>
  );
}

/** A choice of one of few. */
export function Choice<T extends string>({ label, value, options, onChoose }: { label: string; value: T; options: [T, string][]; onChoose: (value: T) => void }) {
  const id = useId();
  return (
    <div class="field">
      <label for={id}>{label}</label>
      <select id={id} value={value} onChange={(event) => onChoose(event.currentTarget.value as T)}>
        {options.map(([name, text]) => <option key={name} value={name}>{text}</option>)}
      </select>
    </div>
  );
}
