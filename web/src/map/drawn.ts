// SPDX-License-Identifier: MIT
/** Reckoning with what people drew. Pure. */
import type { Goal, NamedPlace, NoGoArea } from "../link/types";
import { distance, isInside, type Point, surfaceOf } from "./geometry";

export const LONGEST_NAME = 40;
export const MOST_CORNERS = 64;

export const pointOfPlace = ({ x_m, y_m }: { x_m: number; y_m: number }): Point => ({ x: x_m, y: y_m });
export const cornersOf = ({ corners }: NoGoArea): Point[] => corners.map(([x, y]) => ({ x: x!, y: y! }));

/** The named place that is nearest to a point, and within reach. */
export function placeAt(places: readonly NamedPlace[], point: Point, reach_m: number): NamedPlace | null {
  const away = (place: NamedPlace) => distance(pointOfPlace(place), point);
  const nearest = places.reduce<NamedPlace | null>((best, place) => (best && away(best) <= away(place) ? best : place), null);
  return nearest && away(nearest) <= reach_m ? nearest : null;
}

/** Of the areas that hold a point the smallest: around it there is room to tap the others. */
export function areaAt(areas: readonly NoGoArea[], point: Point): NoGoArea | null {
  const surface = (area: NoGoArea) => surfaceOf(cornersOf(area));
  return areas.filter((area) => isInside(point, cornersOf(area))).sort((a, b) => surface(a) - surface(b))[0] ?? null;
}

/** Whether two names are given to one point. */
export function isSameSpot(a: Goal | null | undefined, b: Goal | null | undefined): boolean {
  return !!a && !!b && a.x_m === b.x_m && a.y_m === b.y_m;
}

/** "No-go 3" when there are 1 and 2. */
export function freeName(taken: readonly string[], word: string): string {
  for (let n = 1; ; ++n) if (!taken.includes(`${word} ${n}`)) return `${word} ${n}`;
}

/** Whether something can be called so. */
export function isName(name: string): boolean {
  return name.length > 0 && [...name].length <= LONGEST_NAME && !name.startsWith(".") && !/[\p{Cc}/\\]/u.test(name);
}
