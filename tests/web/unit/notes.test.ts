// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Autopilot } from "../../../web/src/link/types";
import { areaAt, freeName, isName, isSameSpot, placeAt } from "../../../web/src/map/drawn";
import { isInside, middleOf } from "../../../web/src/map/geometry";
import { pilotWords } from "../../../web/src/pilot/words";

const at = (x: number, y: number) => ({ x, y });
const corner = [at(0, 0), at(4, 0), at(4, 1), at(1, 1), at(1, 4), at(0, 4)];

test("an area holds what is in its outline, whichever way it goes round", () => {
  for (const outline of [corner, [...corner].reverse()]) {
    assert.ok(isInside(at(0.5, 3), outline));
    assert.ok(isInside(at(3, 0.5), outline));
    assert.ok(!isInside(at(3, 3), outline), "in the corner that is left out");
    assert.ok(!isInside(at(-1, 0.5), outline));
  }
  const bow = [at(0, 0), at(2, 2), at(2, 0), at(0, 2)];
  assert.ok(isInside(at(0.5, 1), bow) && isInside(at(1.5, 1), bow) && !isInside(at(1, 1.8), bow));
  assert.ok(!isInside(at(0, 0), []));
  assert.deepEqual(middleOf([at(0, 0), at(4, 2)]), at(2, 1));
});

test("a tap means the nearest place in reach, and of areas the smallest, which could not be tapped otherwise", () => {
  const places = [{ name: "a", x_m: 0, y_m: 0 }, { name: "b", x_m: 1, y_m: 0 }];
  assert.equal(placeAt(places, at(0.6, 0), 0.5)?.name, "b");
  assert.equal(placeAt(places, at(0.5, 2), 0.5), null);
  assert.equal(placeAt([], at(0, 0), 9), null);
  const square = (side: number) => [[0, 0], [side, 0], [side, side], [0, side]];
  const areas = [{ name: "large", corners: square(4) }, { name: "small", corners: square(1) }, { name: "zone", corners: square(3).reverse() }];
  assert.equal(areaAt(areas, at(0.5, 0.5))?.name, "small");
  assert.equal(areaAt(areas, at(2, 2))?.name, "zone");
  assert.equal(areaAt(areas, at(3.5, 2))?.name, "large");
  assert.equal(areaAt(areas, at(5, 2)), null);
});

test("home is the place that is where home is, whatever it is called", () => {
  const home = { x_m: 1, y_m: 2, name: "Dock" };
  assert.ok(isSameSpot(home, { ...home, name: "Sofa" }));
  assert.ok(!isSameSpot(home, { ...home, x_m: 3 }));
  assert.ok(!isSameSpot(null, home) && !isSameSpot(null, null));
});

test("names are what the robot takes for one", () => {
  for (const name of ["Küche", "🤖".repeat(40), "a b?#%", "…"]) assert.ok(isName(name), name);
  for (const name of ["", "🤖".repeat(41), "a/b", "a\\b", ".a", "a\nb", "a\u0085b"]) assert.ok(!isName(name), name);
  assert.equal(freeName(["No-go 1", "No-go 3"], "No-go"), "No-go 2");
});

test("the autopilot's doings are told in words", () => {
  const pilot: Autopilot = { mode: "navigate", phase: "active", reason: "", goal: { x_m: 1, y_m: 2, name: "Sofa" }, route: [], remaining_m: 3.25, places: [], nearest: null };
  assert.deepEqual(pilotWords(null), { what: "By hand", left: "", why: "" });
  assert.deepEqual(pilotWords(pilot), { what: "Driving to Sofa", left: "3.3 m left", why: "" });
  assert.equal(pilotWords({ ...pilot, mode: "explore" }).what, "Exploring");
  assert.equal(pilotWords({ ...pilot, remaining_m: null }).what, "Pausing at Sofa", "a patrol that was there");
  assert.equal(pilotWords({ ...pilot, remaining_m: null, reason: "somebody is in the way" }).what, "Driving to Sofa");
  assert.equal(pilotWords({ ...pilot, reason: "somebody is in the way" }).why, "somebody is in the way");
  assert.deepEqual(pilotWords({ ...pilot, phase: "idle", reason: "it is there" }), { what: "Nothing to do", left: "", why: "it is there" });
  assert.deepEqual(pilotWords({ ...pilot, phase: "stopped", reason: "it touched something" }), { what: "Stopped", left: "", why: "it touched something" });
  assert.equal(pilotWords({ ...pilot, phase: "stopped" }).why, "A person has to look.");
});
