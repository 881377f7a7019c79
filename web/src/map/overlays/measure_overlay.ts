// SPDX-License-Identifier: MIT
import { measure } from "../geometry";
import { measured } from "../tools";
import { metres } from "../words";
import { type Pen, strokeWithHalo, tracePath, write } from "./pen";

export function measureOverlay(pen: Pen): void {
  const points = measured.value;
  if (points.length === 0) return;
  const { context, inks, at } = pen;
  context.beginPath();
  tracePath(pen, points);
  strokeWithHalo(pen, inks.measure, 2.5);
  for (const point of points) {
    context.beginPath();
    context.arc(...at(point), 4, 0, 2 * Math.PI);
    strokeWithHalo(pen, inks.measure, 2.5);
  }
  measure(points).legs_m.forEach((leg_m, i) => {
    const [a, b] = [at(points[i]!), at(points[i + 1]!)];
    write(pen, metres(leg_m), (a[0] + b[0]) / 2, (a[1] + b[1]) / 2 - 12, inks.measure);
  });
}
