// SPDX-License-Identifier: MIT
import type { NoGoArea } from "../../link/types";
import { strings } from "../../strings";
import { cornersOf, pointOfPlace } from "../drawn";
import { middleOf, type Point } from "../geometry";
import { notes } from "../notes";
import { outline, picked } from "../tools";
import { hatch, type Pen, strokeWithHalo, tracePath, write } from "./pen";

const PIN_PX = 11;

/** What people drew: areas that the robot keeps out of, places with a name, home. */
export function notesOverlay(pen: Pen): void {
  if (!notes.value) return;
  for (const area of notes.value.areas) drawArea(pen, area, picked.value?.kind === "area" && picked.value.name === area.name);
  const { home, places } = notes.value;
  for (const place of places) drawPin(pen, place, place.name, picked.value?.kind === "place" && picked.value.name === place.name);
  if (home) drawHome(pen, pointOfPlace(home), picked.value?.kind === "home");
}

/** The area that is being drawn; where it began there is a ring, to end it at. */
export function outlineOverlay(pen: Pen): void {
  const corners = outline.value;
  if (corners.length === 0) return;
  const { context, inks } = pen;
  context.beginPath();
  tracePath(pen, corners);
  if (corners.length > 2) {
    context.closePath();
    context.fillStyle = inks.noGo;
    context.globalAlpha = 0.15;
    context.fill("evenodd");
    context.globalAlpha = 1;
  }
  strokeWithHalo(pen, inks.noGo, 2.5);
  corners.forEach((corner, i) => {
    context.beginPath();
    context.arc(...pen.at(corner), i === 0 ? 9 : 4, 0, 2 * Math.PI);
    strokeWithHalo(pen, inks.noGo, 2.5);
  });
}

function drawArea(pen: Pen, area: NoGoArea, isPicked: boolean): void {
  const { context, inks } = pen;
  const corners = cornersOf(area);
  const path = new Path2D();
  corners.forEach((corner, i) => (i === 0 ? path.moveTo(...pen.at(corner)) : path.lineTo(...pen.at(corner))));
  path.closePath();
  context.fillStyle = inks.noGo;
  context.globalAlpha = isPicked ? 0.3 : 0.12;
  context.fill(path, "evenodd");
  context.globalAlpha = 1;
  hatch(pen, path, inks.noGo, 0.7);
  context.beginPath();
  tracePath(pen, [...corners, corners[0]!]);
  strokeWithHalo(pen, inks.noGo, isPicked ? 3.5 : 2);
  write(pen, area.name, ...pen.at(middleOf(corners)), inks.noGo);
}

/** A drop that points to the place, its name beside it. */
function drawPin(pen: Pen, place: { x_m: number; y_m: number }, name: string, isPicked: boolean): void {
  const { context, inks } = pen;
  const [x, y] = pen.at({ x: place.x_m, y: place.y_m });
  const r = isPicked ? PIN_PX * 0.8 : PIN_PX * 0.62;
  context.beginPath();
  context.moveTo(x, y);
  context.arc(x, y - 2.2 * r, r, 0.75 * Math.PI, 0.25 * Math.PI);
  context.closePath();
  strokeWithHalo(pen, inks.note, 2);
  context.fillStyle = inks.note;
  context.fill();
  write(pen, name, x, y + 11, inks.note);
}

/** A house. */
function drawHome(pen: Pen, home: Point, isPicked: boolean): void {
  const { context, inks } = pen;
  const [x, y] = pen.at(home);
  context.beginPath();
  for (const [dx, dy] of [[-10, 0], [0, -10], [10, 0], [7, 0], [7, 9], [-7, 9], [-7, 0], [-10, 0]] as const) context.lineTo(x + dx, y + dy);
  context.closePath();
  strokeWithHalo(pen, inks.note, isPicked ? 3.5 : 2);
  context.fillStyle = inks.halo;
  context.fill();
  write(pen, strings.map.home, x, y + 19, inks.note);
}
