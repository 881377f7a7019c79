// SPDX-License-Identifier: MIT
import { render } from "preact";
import { App } from "./app";
import { sitDown } from "./drive/cockpit";
import { scanAge_ms } from "./drive/radar";
import { videoAge_ms } from "./drive/video";
import { ask } from "./link/http";
import type { Settings } from "./link/types";
import { followNotes } from "./map/notes";
import { robot } from "./robot";
import { strings } from "./strings";
import { tell } from "./ui/notices";
import "./style.css";

robot.onTrouble = (why) => tell(why ?? strings.noAnswer);
// Several robots are told apart by their names, and a browser's tabs by their titles.
robot.onUp = () => void ask<Settings>("GET", "api/v1/settings").then(({ name }) => (document.title = name), () => {});
robot.start();
sitDown();
followNotes();
// For whoever looks from the browser's console, or measures.
Object.assign(window, { dynslam: { robot, scanAge_ms, videoAge_ms } });
// The keyboard of an iPhone lies over the page, and would lie over STOP.
window.visualViewport?.addEventListener("resize", () => {
  const { height, scale } = window.visualViewport!;
  document.documentElement.style.setProperty("--seen", `${height * scale}px`);
});
render(<App />, document.getElementById("app")!);
