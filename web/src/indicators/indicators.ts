// SPDX-License-Identifier: MIT
import type { Phase } from "../link/robot_link";
import type { Autopilot, State, Wheel } from "../link/types";
import { strings } from "../strings";
import type { IconName } from "../ui/icons";

/** How much an indicator matters now; one that is `off` has nothing to say. */
export type Level = "off" | "plain" | "good" | "warn" | "bad";

export interface Indicator {
  id: string;
  icon: IconName;
  level: Level;
  text: string;
  /** A sentence on what it means. */
  about: string;
}

export interface Seen {
  state: State | null;
  phase: Phase;
  wheel: Wheel;
  mayDrive: boolean;
  delay_ms: number | null;
  /** null: no picture; undefined: nobody looks at the video. */
  videoAge_ms: number | null | undefined;
}

const words = strings.indicators;
const SLOW_LINK_MS = 100;
const BAD_LINK_MS = 200;
const OLD_PICTURE_MS = 300;
const GOOD_QUALITY = 0.5;

const percent = (share: number) => `${Math.round(100 * share)} %`;

/** What the thesis's client showed (appendix B.2), and what ours adds. Pure; the order is the order on the screen. */
export function indicators(seen: Seen): Indicator[] {
  const { state } = seen;
  return [wheel(seen), link(seen), ...(state ? [standing(state, seen), ...ofState(state)] : []), video(seen)];
}

function ofState(state: State): Indicator[] {
  return [
    autopilot(state.autopilot),
    navigation(state.autopilot),
    exploration(state.autopilot),
    battery(state),
    brownout(state),
    near(state),
    collision(state),
    yaw(state),
    tilt(state),
    power(state),
    pose(state),
    lost(state),
    recording(state),
  ];
}

function wheel({ wheel, mayDrive }: Seen): Indicator {
  const make = (level: Level, text: string, about: string): Indicator => ({ id: "wheel", icon: "wheel", level, text, about });
  if (wheel.mine) return make("good", words.wheelMine, words.wheelMineAbout);
  if (wheel.driver !== null) return make("plain", words.wheelOther(wheel.driver), words.wheelOtherAbout);
  return mayDrive ? make("plain", words.wheelFree, words.wheelFreeAbout) : make("plain", words.watching, words.watchingAbout);
}

/** Why the robot does not move, where no other indicator or banner says so. */
const SHOWN_ELSEWHERE = ["none", "e-stop", "stop", "touch", "obstacle", "tilt"];

function standing({ verdict }: State, { wheel }: Seen): Indicator {
  const make = (level: Level): Indicator => ({ id: "standing", icon: "lost", level, text: words.standing, about: verdict?.reason ?? "" });
  const stands = verdict?.motion === "stop" || verdict?.motion === "hold";
  if (!stands || SHOWN_ELSEWHERE.includes(verdict.cause)) return make("off");
  if (verdict.cause === "driver") return make(wheel.mine ? "warn" : "off");
  return make("bad");
}

function link({ phase, delay_ms }: Seen): Indicator {
  const make = (level: Level, text: string): Indicator => ({ id: "link", icon: "link", level, text, about: words.linkAbout });
  if (phase !== "up") return make("bad", words.linkLost);
  if (delay_ms === null) return make("plain", words.linkUp);
  const level = delay_ms < SLOW_LINK_MS ? "good" : delay_ms < BAD_LINK_MS ? "warn" : "bad";
  return make(level, `${Math.round(delay_ms)} ms`);
}

function video({ videoAge_ms }: Seen): Indicator {
  const make = (level: Level, text: string): Indicator => ({ id: "video", icon: "video", level, text, about: words.videoAbout });
  if (videoAge_ms === undefined) return make("off", "");
  if (videoAge_ms === null) return make("warn", words.noVideo);
  return make(videoAge_ms < OLD_PICTURE_MS ? "good" : "warn", `${Math.round(videoAge_ms)} ms`);
}

function autopilot(pilot: Autopilot | null | undefined): Indicator {
  const make = (level: Level, text: string, about: string): Indicator => ({ id: "autopilot", icon: "autopilot", level, text, about });
  if (!pilot) return make("plain", words.byHand, words.byHandAbout);
  if (pilot.phase === "active") return make("good", words.pilotActive, words.pilotActiveAbout);
  if (pilot.phase === "idle") return make("plain", words.pilotIdle, pilot.reason || words.pilotIdleAbout);
  return make("bad", words.pilotStopped, pilot.reason || words.pilotStoppedAbout);
}

function navigation(pilot: Autopilot | null | undefined): Indicator {
  const make = (level: Level, text: string, about: string): Indicator => ({ id: "navigation", icon: "goal", level, text, about });
  if (pilot?.mode !== "navigate") return make("off", "", "");
  if (!pilot.goal) return make("plain", words.noGoal, words.noGoalAbout);
  if (pilot.phase === "stopped" && pilot.route.length === 0) return make("warn", words.noRoute, pilot.reason || words.noRouteAbout);
  const left = pilot.remaining_m === null ? "" : ` ${pilot.remaining_m.toFixed(1)} m`;
  return make("good", words.onTheWay + left, words.onTheWayAbout);
}

function exploration(pilot: Autopilot | null | undefined): Indicator {
  const explores = pilot?.mode === "explore" && pilot.phase === "active";
  return { id: "exploration", icon: "explore", level: explores ? "good" : "off", text: words.exploring, about: words.exploringAbout(pilot?.places.length ?? 0) };
}

function battery({ battery }: State): Indicator {
  const make = (level: Level, text: string, about: string): Indicator => ({ id: "battery", icon: "battery", level, text, about });
  if (!battery || battery.level === "unknown") return make("plain", words.batteryUnknown, words.batteryUnknownAbout);
  const about = words.batteryAbout(battery.voltage_v.toFixed(1));
  if (battery.level === "recharge") return make("bad", words.recharge, about);
  return make(battery.level === "low" ? "warn" : "good", percent(battery.share), about);
}

function brownout({ battery }: State): Indicator {
  return { id: "brownout", icon: "bolt", level: battery?.brownout ? "bad" : "off", text: words.brownout, about: words.brownoutAbout };
}

function near({ verdict }: State): Indicator {
  const level = verdict?.cause !== "obstacle" ? "off" : verdict.motion === "slow" ? "warn" : "bad";
  return { id: "near", icon: "near", level, text: words.near, about: verdict?.reason ?? "" };
}

function collision({ collision }: State): Indicator {
  return { id: "collision", icon: "collision", level: collision ? "bad" : "off", text: words.collision, about: words.collisionAbout };
}

function yaw({ pose }: State): Indicator {
  return { id: "yaw", icon: "yaw", level: pose?.unsteady === "turning" ? "warn" : "off", text: words.yaw, about: words.yawAbout };
}

function tilt({ pose, verdict }: State): Indicator {
  const level = verdict?.cause === "tilt" ? "bad" : pose?.unsteady === "tilting" ? "warn" : "off";
  return { id: "tilt", icon: "tilt", level, text: words.tilt, about: level === "bad" ? (verdict?.reason ?? "") : words.tiltAbout };
}

function power({ power, power_limit }: State): Indicator {
  const applied = power ? Math.max(Math.abs(power.left), Math.abs(power.right)) : 0;
  return { id: "power", icon: "power", level: "plain", text: percent(applied), about: words.powerAbout(percent(applied), percent(power_limit)) };
}

function pose({ pose }: State): Indicator {
  const make = (level: Level, text: string): Indicator => ({ id: "pose", icon: "pose", level, text, about: words.poseAbout });
  if (!pose) return make("plain", words.poseUnknown);
  return make(pose.quality >= GOOD_QUALITY ? "good" : "warn", percent(pose.quality));
}

function lost({ pose }: State): Indicator {
  return { id: "lost", icon: "lost", level: pose?.lost ? "bad" : "off", text: words.lost, about: words.lostAbout };
}

function recording({ recording }: State): Indicator {
  const make = (level: Level, text: string, about: string): Indicator => ({ id: "recording", icon: "record", level, text, about });
  if (recording?.active && recording.asked_for) return make("bad", words.recording(Math.round(recording.seconds)), words.recordingAbout(recording.file));
  if (recording?.trouble) return make("warn", words.recordingBroke, recording.trouble);
  return make("off", "", "");
}
