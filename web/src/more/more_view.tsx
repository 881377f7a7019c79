// SPDX-License-Identifier: MIT
import type { ComponentType } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { strings } from "../strings";
import { AboutSection } from "./about_section";
import { HealthSection } from "./health_section";
import { LogSection } from "./log_section";
import { MapsSection } from "./maps_section";
import "./more.css";
import { PeopleSection } from "./people_section";
import { RecordingsSection } from "./recordings_section";
import { addressOf, isRoomy, section, SECTIONS, type Section } from "./section";
import { SettingsSection } from "./settings_section";

const CONTENTS: Record<Section, ComponentType> = {
  health: HealthSection,
  recordings: RecordingsSection,
  maps: MapsSection,
  people: PeopleSection,
  settings: SettingsSection,
  log: LogSection,
  about: AboutSection,
};

/** Sections, on a phone one after the other, on a laptop beside the list of them. */
export function MoreView() {
  const chosen = section.value;
  return (
    <section class="view more" aria-label={strings.views.more}>
      {(isRoomy.value || !chosen) && <SectionList current={chosen ?? (isRoomy.value ? "health" : null)} />}
      {(isRoomy.value || chosen) && <Shown key={chosen} name={chosen ?? "health"} />}
    </section>
  );
}

function SectionList({ current }: { current: Section | null }) {
  return (
    <nav class="more-list" aria-label={strings.more.list}>
      <h2>{strings.views.more}</h2>
      <ul>
        {SECTIONS.map((name) => (
          <li key={name}>
            <a href={addressOf(name)} aria-current={name === current ? "page" : undefined}>
              <span>{strings.more.sections[name]}</span>
              <small>{strings.more.summaries[name]}</small>
            </a>
          </li>
        ))}
      </ul>
    </nav>
  );
}

function Shown({ name }: { name: Section }) {
  const heading = useRef<HTMLHeadingElement>(null);
  // Who came here by the list goes on reading here. Not when the page was just loaded.
  useEffect(() => {
    if (document.activeElement !== document.body || !isRoomy.value) heading.current?.focus({ preventScroll: true });
  }, []);
  const Content = CONTENTS[name];
  return (
    <div class="more-section">
      {!isRoomy.value && <a class="back" href="#more">{strings.more.back}</a>}
      <h2 ref={heading} tabIndex={-1}>{strings.more.sections[name]}</h2>
      <Content />
    </div>
  );
}
