// SPDX-License-Identifier: MIT
import type { Device } from "../link/types";
import { strings } from "../strings";
import { ageText } from "./format";

/** `resting`: says nothing, and need not. */
export type Condition = "good" | "trouble" | "silent" | "absent" | "resting";

/** Longer than any device but the camera takes between two samples, with what the network adds. */
const SILENT_AFTER_MS = 2500;

/** How a device does; `age_ms` is since its last sample, null when that is not known. Pure. */
export function conditionOf(device: string, health: Device, age_ms: number | null): Condition {
  if (!health.present) return "absent";
  if (health.trouble) return "trouble";
  const isSilent = !health.samples || (age_ms !== null && age_ms > SILENT_AFTER_MS);
  if (!isSilent) return "good";
  return device === "camera" ? "resting" : "silent";
}

/** What to do about a device in plain words; null when it works. Pure. */
export function advice(device: string, health: Device, age_ms: number | null): string | null {
  const condition = conditionOf(device, health, age_ms);
  if (condition === "good") return null;
  const words = strings.more.advice;
  if (condition === "resting") return words.resting;
  const own = isKnown(device) ? words[device] : null;
  if (condition === "absent") return own?.absent ?? words.absent;
  if (condition === "silent") return silence(health, age_ms, own?.silent ?? words.silent);
  if (/permission denied/i.test(health.trouble ?? "") && own) return words.permission(own.group);
  return own?.trouble ?? words.trouble;
}

type Known = "lidar" | "imu" | "motors" | "camera" | "pins" | "wheels";
const isKnown = (device: string): device is Known => ["lidar", "imu", "motors", "camera", "pins", "wheels"].includes(device);

function silence(health: Device, age_ms: number | null, what: string): string {
  const words = strings.more.advice;
  return `${!health.samples || age_ms === null ? words.noDataYet : words.noDataFor(ageText(age_ms))} ${what}`;
}
