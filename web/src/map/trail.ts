// SPDX-License-Identifier: MIT
/** Where the robot was. Pure; metres in the frame `map`. */
import { distance, type Point } from "./geometry";

const FIRST_STEP_M = 0.05;
const JUMP_M = 1;
const MOST = 4000;

/**
 * A line that does not grow without end: points closer than a step are left out, and when there are too many, every
 * second goes and the step doubles. It breaks where the robot jumped, as when its place was corrected.
 */
export class Trail {
  private parts: Point[][] = [];
  private count = 0;
  private step_m = FIRST_STEP_M;

  constructor(private readonly most = MOST) {}

  get lines(): readonly (readonly Point[])[] {
    return this.parts;
  }

  /** Whether it is another trail now. */
  add(point: Point): boolean {
    const part = this.parts.at(-1);
    const last = part?.at(-1);
    const far_m = last ? distance(last, point) : Infinity;
    if (far_m < this.step_m) return false;
    if (!part || far_m > Math.max(JUMP_M, 3 * this.step_m)) this.parts.push([point]);
    else part.push(point);
    if (++this.count > this.most) this.thin();
    return true;
  }

  clear(): void {
    this.parts = [];
    this.count = 0;
    this.step_m = FIRST_STEP_M;
  }

  private thin(): void {
    this.step_m *= 2;
    this.parts = this.parts.map((part) => part.filter((_, i) => i % 2 === 0 || i === part.length - 1)).filter((part) => part.length > 1);
    this.count = this.parts.reduce((sum, part) => sum + part.length, 0);
  }
}
