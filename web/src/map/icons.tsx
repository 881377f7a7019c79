// SPDX-License-Identifier: MIT

const PATHS = {
  follow: "M12 3v3M12 18v3M3 12h3M18 12h3M6 12a6 6 0 1 0 12 0 6 6 0 1 0-12 0M10 12a2 2 0 1 0 4 0 2 2 0 1 0-4 0",
  centre: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5M12 8l4 8-4-2-4 2z",
  zoomIn: "M12 5v14M5 12h14",
  zoomOut: "M5 12h14",
  goal: "M6 21V4M6 4h12l-3 4 3 4H6",
  measure: "M3 16 16 3l5 5L8 21zM7 12l2 2M10 9l3 3M13 6l2 2",
  layers: "M12 4 3 9l9 5 9-5zM3 14l9 5 9-5",
  save: "M12 4v11M7 10l5 5 5-5M4 20h16",
  turnLeft: "M5 5v5h5M5.5 10a7 7 0 1 1-.5 5",
  turnRight: "M19 5v5h-5M18.5 10a7 7 0 1 0 .5 5",
};

export type IconName = keyof typeof PATHS;

export function Icon({ name }: { name: IconName }) {
  return (
    <svg class="icon" viewBox="0 0 24 24" aria-hidden="true">
      <path d={PATHS[name]} fill="none" stroke="currentColor" stroke-width="2" stroke-linecap="round" stroke-linejoin="round" />
    </svg>
  );
}
