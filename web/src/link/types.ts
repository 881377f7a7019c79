// SPDX-License-Identifier: MIT
/** What the robot says and takes, by the names of openapi.yaml. */
import type { components } from "./api";

type Schemas = components["schemas"];
export type State = Schemas["State"];
export type PoseEstimate = NonNullable<State["pose"]>;
export type Verdict = NonNullable<State["verdict"]>;
export type Battery = NonNullable<State["battery"]>;
export type Autopilot = Schemas["Autopilot"];
export type Graph = Schemas["Graph"];
export type Goal = Schemas["Goal"];
export type Notes = Schemas["Notes"];
export type NamedPlace = Notes["places"][number];
export type NoGoArea = Notes["areas"][number];
export type Device = Schemas["Device"];
export type Devices = Schemas["Devices"];
export type Recording = Schemas["Recording"];
export type Me = Schemas["Me"];
export type Role = Schemas["Role"];
export type Credential = Schemas["Credential"];
export type Settings = Schemas["Settings"];
export type LogLine = Schemas["LogLine"];

/** Metres a second ahead, radians a second to the left. */
export interface Twist {
  v: number;
  w: number;
}

/** Who holds the wheel: this page, somebody by name, or nobody. */
export interface Wheel {
  mine: boolean;
  driver: string | null;
}
