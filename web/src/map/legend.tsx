// SPDX-License-Identifier: MIT
import { robot } from "../robot";
import { strings } from "../strings";
import { measure, scaleBar } from "./geometry";
import { layers } from "./layers";
import { inks, palette } from "./look";
import { AGE_SHADES } from "./overlays/age_overlay";
import { KINDS, markOf } from "./overlays/places_overlay";
import { pixelsPerMetre } from "./scene";
import { measured, tool } from "./tools";
import { metres } from "./words";

const SCALE_ROOM_PX = 120;

export function ScaleBar() {
  if (pixelsPerMetre.value === 0) return null;
  const { length_m, length_px } = scaleBar(pixelsPerMetre.value, SCALE_ROOM_PX);
  return <p class="map-scale" style={{ width: `${length_px}px` }}>{length_m < 1 ? `${Math.round(100 * length_m)} cm` : `${length_m} m`}</p>;
}

export function MeasurePanel() {
  if (tool.value !== "measure") return null;
  const points = measured.value;
  return <p class="map-panel" role="status">{points.length < 2 ? strings.map.tapMeasure : strings.map.total(metres(measure(points).total_m))}</p>;
}

/** What the signs mean that do not explain themselves. */
export function Legend() {
  const hasPlaces = layers.value.places && (robot.state.value?.autopilot?.places.length ?? 0) > 0;
  if (!layers.value.age && !hasPlaces) return null;
  return (
    <ul class="map-legend">
      {hasPlaces && KINDS.map((kind) => (
        <li key={kind}>
          <svg viewBox="-9 -9 18 18" aria-hidden="true"><polygon points={markOf(kind)} fill="none" stroke={inks.value[kind]} stroke-width="2.5" /></svg>
          {strings.map.places[kind]}
        </li>
      ))}
      {layers.value.age && AGE_SHADES.map((shade, step) => (
        <li key={step}>
          <svg viewBox="0 0 18 18" aria-hidden="true">
            <rect width="18" height="18" fill={floor()} stroke="currentColor" />
            <rect width="18" height="18" fill={inks.value.age} fill-opacity={shade} />
            {step === AGE_SHADES.length - 1 && <path d="M0 9 9 0M0 18 18 0M9 18 18 9" stroke={inks.value.age} />}
          </svg>
          {strings.map.ages[step]}
        </li>
      ))}
    </ul>
  );
}

function floor(): string {
  return `#${palette.value.free[1].toString(16).padStart(6, "0")}`;
}
