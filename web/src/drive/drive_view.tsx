// SPDX-License-Identifier: MIT
import { IndicatorBar } from "../indicators/indicator_bar";
import { Minimap } from "../map/minimap";
import { isPilotOpen } from "../pilot/pages";
import { PilotPanel } from "../pilot/pilot_panel";
import { robot } from "../robot";
import { show } from "../ui/view";
import { minimapSize, MINIMAP_SIZES, steering } from "./cockpit";
import { Joystick } from "./joystick";
import { Power } from "./power";
import { Radar } from "./radar";
import { Video } from "./video";
import { WheelButton } from "./wheel_button";
import "./drive.css";
import type { Stick } from "./stick";

const steer = (stick: Stick) => steering.set("joystick", stick);

export function DriveView() {
  return (
    <section class="view drive">
      <Video />
      <div class="drive-status">
        <IndicatorBar />
      </div>
      <div class="drive-around">
        <Minimap size={MINIMAP_SIZES[minimapSize.value]!} onTap={() => show("map")} />
        <Radar />
      </div>
      <div class="drive-controls">
        {robot.wheel.value.mine ? <Joystick steer={steer} /> : <WheelButton />}
        <Power />
      </div>
      {isPilotOpen.value && <div class="drive-pilot"><PilotPanel /></div>}
    </section>
  );
}
