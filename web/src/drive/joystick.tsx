// SPDX-License-Identifier: MIT
import nipplejs from "nipplejs";
import { useEffect, useRef } from "preact/hooks";
import { strings } from "../strings";
import { CENTRED, type Stick } from "./stick";

const SIZE_PX = 150;
const byMouse = matchMedia("(pointer: fine)").matches;

/**
 * A stick that comes up under the thumb, anywhere in its zone. When the page loses attention the stick is thrown away
 * with whatever the library thinks of the touch that held it: a stick that hangs would drive the robot.
 */
export function Joystick({ steer }: { steer: (stick: Stick) => void }) {
  const zone = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const element = zone.current!;
    let release = plant(element, steer);
    const replant = () => {
      release();
      release = plant(element, steer);
    };
    // The library goes by pointers, and a phone may forget to tell that one is gone: its touches are a second witness.
    const untouched = (event: Event) => {
      if ((event as TouchEvent).targetTouches.length === 0) replant();
    };
    element.addEventListener("touchend", untouched);
    const losses: [EventTarget, string][] = [
      [window, "blur"],
      [window, "resize"],
      [document, "visibilitychange"],
      [element, "pointercancel"],
      [element, "touchcancel"],
    ];
    for (const [target, event] of losses) target.addEventListener(event, replant);
    return () => {
      element.removeEventListener("touchend", untouched);
      for (const [target, event] of losses) target.removeEventListener(event, replant);
      release();
    };
  }, [steer]);
  return (
    <div class="joystick" ref={zone} onContextMenu={(event) => event.preventDefault()}>
      <p class="joystick-hint" aria-hidden="true">{byMouse ? strings.drive.mouseHint : strings.drive.joystickHint}</p>
    </div>
  );
}

/** Gives what takes it away again. */
function plant(zone: HTMLElement, steer: (stick: Stick) => void): () => void {
  const manager = nipplejs.create({ zone, mode: "dynamic", size: SIZE_PX, color: "var(--stick)", fadeTime: 0, restOpacity: 0 });
  zone.classList.remove("joystick-held");
  manager.on("start", () => zone.classList.add("joystick-held"));
  manager.on("move", (_, data) => steer({ ahead: data.vector.y, left: -data.vector.x }));
  manager.on("end", () => {
    zone.classList.remove("joystick-held");
    steer(CENTRED);
  });
  return () => {
    manager.destroy();
    for (const left of zone.querySelectorAll(".nipple")) left.remove();
    steer(CENTRED);
  };
}
