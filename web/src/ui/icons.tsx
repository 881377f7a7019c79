// SPDX-License-Identifier: MIT

/** Drawn on 24 x 24, in the text's colour. */
const PATHS = {
  wheel: "M12 3a9 9 0 1 0 0 18 9 9 0 0 0 0-18zm0 7a2 2 0 1 1 0 4 2 2 0 0 1 0-4zM3.4 10.5h6.800M13.8 10.5h6.800M12 14v7",
  link: "M4 9.5a12 12 0 0 1 16 0M7 13a7.5 7.5 0 0 1 10 0M10.2 16.400a3 3 0 0 1 3.6 0M12 19.5v.01",
  video: "M3 7h12v10H3zM15 10.5l6-3v9l-6-3",
  autopilot: "M5 20V4h6a5 5 0 0 1 0 10H5M16 20l2-6 2 6",
  goal: "M12 21s-6-6.5-6-11a6 6 0 0 1 12 0c0 4.5-6 11-6 11zM12 8v4M10 10h4",
  explore: "M10.5 4a6.5 6.5 0 1 0 0 13 6.5 6.5 0 0 0 0-13zM15.5 15.5L21 21",
  battery: "M3 8h15v8H3zM18 10.5h2.5v3H18M6 11v2M9 11v2M12 11v2",
  bolt: "M13 3L6 13h5l-1 8 7-10h-5z",
  near: "M4 4v16M8 12h4M20 8v8h-5V8z",
  collision: "M12 2l2.5 5.5L20 5l-2.5 5.5L22 13l-5.5 1 1 6-5.5-3.5L6.5 20l1-6L2 13l4.5-2.5L4 5l5.5 2.5z",
  yaw: "M20 12a8 8 0 1 1-3-6.200M20 3v4h-4",
  tilt: "M3 19h18M4 15l14-8M15 6l3.5.8-.8 3.5",
  power: "M4 17a8.5 8.5 0 1 1 16 0M12 14l4-5",
  pose: "M12 3v4M12 17v4M3 12h4M17 12h4M12 8.5a3.5 3.5 0 1 0 0 7 3.5 3.5 0 0 0 0-7z",
  lost: "M9 9a3 3 0 1 1 4.5 2.600c-1 .6-1.5 1.2-1.5 2.400M12 17.5v.01M12 2.5a9.5 9.5 0 1 0 0 19 9.5 9.5 0 0 0 0-19z",
  follow: "M12 3v3M12 18v3M3 12h3M18 12h3M6 12a6 6 0 1 0 12 0 6 6 0 1 0-12 0M10 12a2 2 0 1 0 4 0 2 2 0 1 0-4 0",
  centre: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5M12 8l4 8-4-2-4 2z",
  zoomIn: "M12 5v14M5 12h14",
  zoomOut: "M5 12h14",
  flag: "M6 21V4M6 4h12l-3 4 3 4H6",
  measure: "M3 16 16 3l5 5L8 21zM7 12l2 2M10 9l3 3M13 6l2 2",
  layers: "M12 4 3 9l9 5 9-5zM3 14l9 5 9-5",
  save: "M12 4v11M7 10l5 5 5-5M4 20h16",
  turnLeft: "M5 5v5h5M5.5 10a7 7 0 1 1-.5 5",
  turnRight: "M19 5v5h-5M18.5 10a7 7 0 1 0 .5 5",
  noGo: "M4 8l5-4 8 2 3 7-5 7-9-2zM8 18l9-11M5.5 14l5-7",
  close: "M6 6l12 12M18 6L6 18",
  up: "M5 15l7-7 7 7",
  down: "M5 9l7 7 7-7",
  record: "M12 7a5 5 0 1 0 0 10 5 5 0 0 0 0-10z",
};
export type IconName = keyof typeof PATHS;

export function Icon({ name }: { name: IconName }) {
  return (
    <svg class="icon" viewBox="0 0 24 24" width="22" height="22" fill="none" stroke="currentColor" stroke-width="2" stroke-linecap="round" stroke-linejoin="round" aria-hidden="true">
      <path d={PATHS[name]} />
    </svg>
  );
}
