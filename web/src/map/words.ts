// SPDX-License-Identifier: MIT

/** A length for people. */
export function metres(length_m: number): string {
  if (length_m < 1) return `${Math.round(100 * length_m)} cm`;
  return `${length_m.toFixed(length_m < 100 ? 2 : 0)} m`;
}
