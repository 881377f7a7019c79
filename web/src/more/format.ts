// SPDX-License-Identifier: MIT
/** Numbers as people read them. Pure. */

const UNITS = ["B", "kB", "MB", "GB", "TB"];

/** "113 kB", "1.2 GB": powers of 1000, as disks are sold. Does not break between lines. */
export function sizeText(bytes: number): string {
  const power = bytes < 1000 ? 0 : Math.min(UNITS.length - 1, Math.floor(Math.log10(bytes) / 3));
  const value = bytes / 1000 ** power;
  // 999.95 kB would round to "1000 kB".
  if (value >= 999.5 && power < UNITS.length - 1) return `1.0\u00a0${UNITS[power + 1]}`;
  return `${power > 0 && value < 9.95 ? value.toFixed(1) : value.toFixed(0)}\u00a0${UNITS[power]}`;
}

/** "14 140": narrow spaces keep large numbers readable in every language. */
export function countText(n: number): string {
  return String(Math.round(n)).replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

/** "8 s", "3:07", "12:34:56". */
export function clockText(seconds: number): string {
  const whole = Math.max(0, Math.floor(seconds));
  if (whole < 60) return `${whole} s`;
  const two = (n: number) => String(n).padStart(2, "0");
  const hours = Math.floor(whole / 3600);
  const minutes = Math.floor(whole / 60) % 60;
  return `${hours > 0 ? `${hours}:${two(minutes)}` : minutes}:${two(whole % 60)}`;
}

/** How long ago a sample came: "0.3 s", then as clockText. */
export function ageText(age_ms: number): string {
  return age_ms < 9950 ? `${(age_ms / 1000).toFixed(1)} s` : clockText(Math.round(age_ms / 1000));
}

/** "2 min", "5 h", "3 days"; empty when it is less than a minute and a half, which nobody needs to know more exactly. */
export function longAgeText(seconds: number): string {
  if (seconds < 90) return "";
  if (seconds < 5400) return `${Math.round(seconds / 60)} min`;
  if (seconds < 36 * 3600) return `${Math.round(seconds / 3600)} h`;
  return `${Math.round(seconds / 86400)} days`;
}

/** When the recording `name` was begun, as its name tells; null when it does not. */
export function recordedAt(name: string): Date | null {
  const parts = /(\d{4})(\d\d)(\d\d)-(\d\d)(\d\d)(\d\d)/.exec(name);
  if (!parts) return null;
  const [year, month, day, hour, minute, second] = parts.slice(1).map(Number) as [number, number, number, number, number, number];
  const at = new Date(Date.UTC(year, month - 1, day, hour, minute, second));
  return at.getUTCMonth() === month - 1 && at.getUTCDate() === day && hour < 24 && minute < 60 && second < 60 ? at : null;
}
