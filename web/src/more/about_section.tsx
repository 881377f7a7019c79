// SPDX-License-Identifier: MIT
import { robot } from "../robot";
import { strings } from "../strings";
import { useAsked } from "./asking";
import { clockText } from "./format";
import { LIBRARIES } from "./licences";
import { Part, Trouble } from "./parts";

interface Health {
  version: string;
  uptime_s: number;
}
interface Worlds {
  current: string | null;
}

export function AboutSection() {
  const words = strings.more.about;
  const { value: health, trouble } = useAsked<Health>("healthz", 5000);
  const { value: worlds } = useAsked<Worlds>("api/v1/worlds");
  return (
    <>
      <Part title={words.robot}>
        <Trouble text={trouble} />
        <dl class="facts">
          <div><dt>{words.version}</dt><dd>{health?.version ?? "…"}</dd></div>
          <div><dt>{words.uptime}</dt><dd>{health ? clockText(health.uptime_s) : "…"}</dd></div>
          {worlds?.current && <div><dt>{words.world}</dt><dd>{worlds.current}</dd></div>}
          {robot.state.value?.map_id && <div><dt>{words.map}</dt><dd>{robot.state.value.map_id}</dd></div>}
          <div class="wide"><dt>{words.address}</dt><dd class="breaks">{location.origin}</dd></div>
        </dl>
      </Part>
      <Part title={words.programs}>
        <p>{words.programsWhat}</p>
        <div class="buttons"><a class="button" href="api/v1/openapi.yaml" target="_blank" rel="noopener">openapi.yaml</a></div>
      </Part>
      <Part title={words.licences}>
        <p>{words.licencesWhat}</p>
        {LIBRARIES.map(({ name, licence, text }) => (
          <details key={name} class="licence">
            <summary>{`${name}: ${licence}`}</summary>
            <pre tabIndex={0} aria-label={words.licenceOf(name)}>{text}</pre>
          </details>
        ))}
      </Part>
    </>
  );
}
