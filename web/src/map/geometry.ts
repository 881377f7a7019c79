// SPDX-License-Identifier: MIT
/** Reckoning for what is drawn over the map. Pure; metres and radians in the frame `map`. */

export interface Point {
  x: number;
  y: number;
}

export interface Covariance {
  xx_m2: number;
  xy_m2: number;
  yy_m2: number;
}

/** Half axes, and how far the long one is turned to the left from x. */
export interface Ellipse {
  long_m: number;
  short_m: number;
  turned_rad: number;
}

/** Where the position is, within so many standard deviations; null when the covariance is none. */
export function ellipseOf({ xx_m2, xy_m2, yy_m2 }: Covariance, sigmas: number): Ellipse | null {
  const mean = (xx_m2 + yy_m2) / 2;
  const spread = Math.hypot((xx_m2 - yy_m2) / 2, xy_m2);
  if (!Number.isFinite(spread) || !(mean >= 0)) return null;
  return {
    long_m: sigmas * Math.sqrt(mean + spread),
    short_m: sigmas * Math.sqrt(Math.max(0, mean - spread)),
    turned_rad: Math.atan2(2 * xy_m2, xx_m2 - yy_m2) / 2,
  };
}

/** The legs' lengths, and their sum. */
export function measure(points: readonly Point[]): { legs_m: number[]; total_m: number } {
  const legs_m = points.slice(1).map((point, i) => distance(points[i]!, point));
  return { legs_m, total_m: legs_m.reduce((sum, leg) => sum + leg, 0) };
}

export function distance(a: Point, b: Point): number {
  return Math.hypot(b.x - a.x, b.y - a.y);
}

/** The longest round length (1, 2 or 5 times a power of ten) that has room in `room_px`. */
export function scaleBar(pixelsPerMetre: number, room_px: number): { length_m: number; length_px: number } {
  const most_m = room_px / pixelsPerMetre;
  const power = 10 ** Math.floor(Math.log10(most_m));
  const length_m = ([5, 2].find((times) => times * power <= most_m) ?? 1) * power;
  return { length_m, length_px: length_m * pixelsPerMetre };
}

/** Until when a part of the map is fresh, ageing, old; seconds since it changed. */
export const AGE_STEPS_S = [60, 300, 1800] as const;

/** 0 fresh to 3 oldest. */
export function ageStep(age_s: number): number {
  return AGE_STEPS_S.filter((step_s) => age_s >= step_s).length;
}

/** Whether a point is in an outline, which may cross itself: what it goes round an odd number of times is in it. */
export function isInside(point: Point, corners: readonly Point[]): boolean {
  let isIn = false;
  corners.forEach((a, i) => {
    const b = corners[(i + 1) % corners.length]!;
    if (a.y > point.y !== b.y > point.y && point.x < a.x + ((point.y - a.y) / (b.y - a.y)) * (b.x - a.x)) isIn = !isIn;
  });
  return isIn;
}

/** Of the points. */
export function middleOf(points: readonly Point[]): Point {
  const sum = points.reduce((all, { x, y }) => ({ x: all.x + x, y: all.y + y }), { x: 0, y: 0 });
  return { x: sum.x / points.length, y: sum.y / points.length };
}

/** Of an outline that does not cross itself, square metres. */
export function surfaceOf(corners: readonly Point[]): number {
  const twice = corners.reduce((sum, a, i) => {
    const b = corners[(i + 1) % corners.length]!;
    return sum + a.x * b.y - b.x * a.y;
  }, 0);
  return Math.abs(twice) / 2;
}
