// SPDX-License-Identifier: MIT
import { robot } from "../robot";

/** Saves the robot's own picture of the map as a file. */
export async function savePicture(): Promise<void> {
  try {
    const answer = await fetch("api/v1/map.png", { cache: "no-store" });
    if (!answer.ok) return robot.onTrouble(((await answer.json()) as { error: string }).error);
    save(await answer.blob(), pictureName(new Date()));
  } catch {
    robot.onTrouble(null);
  }
}

/** By the local time, to the minute: `map-2025-03-09-1405.png`. */
export function pictureName(now: Date): string {
  const two = (value: number) => String(value).padStart(2, "0");
  return `map-${now.getFullYear()}-${two(now.getMonth() + 1)}-${two(now.getDate())}-${two(now.getHours())}${two(now.getMinutes())}.png`;
}

function save(file: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(file);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000); // Safari reads it later
}
