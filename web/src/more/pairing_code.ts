// SPDX-License-Identifier: MIT

/**
 * The code that was meant, as "ABCD-2345"; null when it is none. As the robot reads it: dashes, blanks and case do not
 * matter, and letters that look like digits are these. So a slip of the finger is no wrong guess. Pure.
 */
export function cleanCode(typed: string): string | null {
  const letters = typed.toUpperCase().replace(/[-\s\u2010-\u2015]/g, "").replace(/O/g, "0").replace(/[IL]/g, "1");
  return /^[0-9A-HJKMNP-TV-Z]{8}$/.test(letters) ? `${letters.slice(0, 4)}-${letters.slice(4)}` : null;
}

/** The code in the part of an address behind the `#`; null when there is none. Pure. */
export function codeInHash(hash: string): string | null {
  return /^#pair=([\w-]{1,64})$/.exec(hash)?.[1] ?? null;
}
