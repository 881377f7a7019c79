// SPDX-License-Identifier: MIT
import { strings } from "../strings";

export type Counts = Record<string, number>;

const RISEN_FOR_MS = 10000;

/** Remembers which counters rose lately. */
export class RisingCounters {
  private before: Counts | null = null;
  private rose_ms = new Map<string, number>();

  see(counts: Counts, now_ms: number): void {
    // What was there when one began to look did not rise; a new name did.
    if (this.before) for (const [name, n] of Object.entries(counts)) if (n > (this.before[name] ?? 0)) this.rose_ms.set(name, now_ms);
    this.before = counts;
  }

  hasRisen(name: string, now_ms: number): boolean {
    return now_ms - (this.rose_ms.get(name) ?? -Infinity) < RISEN_FOR_MS;
  }
}

/** What a counter counts, of itself or of the family that its name begins with; empty when that is not known. */
export function meaningOf(name: string): string {
  const meanings: Record<string, string> = strings.more.counterMeanings;
  const known = meanings[name];
  if (known !== undefined) return known;
  const family = Object.keys(meanings).find((key) => key.endsWith(".*") && name.startsWith(key.slice(0, -1)));
  return family === undefined ? "" : `${meanings[family]}: ${name.slice(family.length - 1)}`;
}
