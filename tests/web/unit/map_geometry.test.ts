// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import test from "node:test";
import { AGE_STEPS_S, ageStep, ellipseOf, measure, scaleBar } from "../../../web/src/map/geometry";
import { Trail } from "../../../web/src/map/trail";
import { TileWatch } from "../../../web/src/map/tile_watch";
import { metres } from "../../../web/src/map/words";

function near(a: number, b: number): void {
  assert.ok(Math.abs(a - b) < 1e-9, `${a} is not ${b}`);
}

test("an ellipse of the covariance: along the axes, and turned", () => {
  const along = ellipseOf({ xx_m2: 0.09, xy_m2: 0, yy_m2: 0.01 }, 2)!;
  near(along.long_m, 0.6);
  near(along.short_m, 0.2);
  near(along.turned_rad, 0);
  near(Math.abs(ellipseOf({ xx_m2: 0.01, xy_m2: 0, yy_m2: 0.09 }, 2)!.turned_rad), Math.PI / 2);
  // The same, turned by 30 degrees to the left.
  const [c, s] = [Math.cos(Math.PI / 6), Math.sin(Math.PI / 6)];
  const turned = ellipseOf({ xx_m2: 0.09 * c * c + 0.01 * s * s, xy_m2: 0.08 * c * s, yy_m2: 0.09 * s * s + 0.01 * c * c }, 2)!;
  near(turned.long_m, 0.6);
  near(turned.short_m, 0.2);
  near(turned.turned_rad, Math.PI / 6);
});

test("what is no covariance is no ellipse; rounding below nothing is nothing", () => {
  assert.equal(ellipseOf({ xx_m2: NaN, xy_m2: 0, yy_m2: 1 }, 2), null);
  assert.equal(ellipseOf({ xx_m2: -1, xy_m2: 0, yy_m2: -1 }, 2), null);
  assert.equal(ellipseOf({ xx_m2: 1, xy_m2: 1.0000001, yy_m2: 1 }, 1)!.short_m, 0);
});

test("measuring: each leg and the sum", () => {
  assert.deepEqual(measure([]), { legs_m: [], total_m: 0 });
  assert.deepEqual(measure([{ x: 1, y: 1 }]), { legs_m: [], total_m: 0 });
  assert.deepEqual(measure([{ x: 0, y: 0 }, { x: 3, y: 4 }, { x: 3, y: -2 }]), { legs_m: [5, 6], total_m: 11 });
  assert.equal(metres(0.256), "26 cm");
  assert.equal(metres(11), "11.00 m");
  assert.equal(metres(123.4), "123 m");
});

test("the scale bar is a round length that has room", () => {
  for (let zoom = -7; zoom <= 5; zoom += 0.5) {
    const pixelsPerMetre = 50 * 2 ** zoom;
    const { length_m, length_px } = scaleBar(pixelsPerMetre, 120);
    assert.ok(length_px <= 120 + 1e-9 && length_px >= 120 / 2.5 - 1e-9, `${length_px} px at ${zoom}`);
    near(length_px, length_m * pixelsPerMetre);
    assert.match(Number(length_m.toPrecision(6)).toExponential(), /^[125]e/);
  }
});

test("age in steps", () => {
  assert.equal(ageStep(0), 0);
  AGE_STEPS_S.forEach((step_s, i) => {
    assert.equal(ageStep(step_s - 0.1), i);
    assert.equal(ageStep(step_s), i + 1);
  });
});

test("a trail leaves out what is close, and breaks where the robot jumped", () => {
  const trail = new Trail();
  assert.equal(trail.add({ x: 0, y: 0 }), true);
  assert.equal(trail.add({ x: 0.04, y: 0 }), false);
  assert.equal(trail.add({ x: 0.06, y: 0 }), true);
  assert.equal(trail.add({ x: 1.0, y: 0 }), true);
  assert.equal(trail.add({ x: 2.1, y: 0 }), true);
  assert.deepEqual(trail.lines.map((line) => line.length), [3, 1]);
  trail.clear();
  assert.deepEqual(trail.lines, []);
});

test("a trail stays bounded, and keeps its ends", () => {
  const trail = new Trail(100);
  for (let i = 0; i <= 10000; ++i) trail.add({ x: 0.06 * i, y: 0 });
  const points = trail.lines.flat();
  assert.ok(points.length <= 101 && points.length > 40, `${points.length} points`);
  assert.equal(trail.lines.length, 1, "thinning does not break it");
  assert.equal(points[0]!.x, 0);
  assert.ok(600 - points.at(-1)!.x < 20);
});

test("only tiles that are shown and have changed are asked for, once", () => {
  const none = new Set<string>();
  let due = 0;
  const watch = new TileWatch(() => ++due);
  const near = { level: 0, x: 0, y: -1 };
  const wide = { level: 3, x: 0, y: -1 };
  const drawn: string[] = [];
  watch.add(near, () => drawn.push("near"));
  watch.add(wide, () => drawn.push("wide"));
  assert.equal(due, 2);
  assert.deepEqual(watch.takeDue(none), [near, wide]);
  assert.deepEqual(watch.takeDue(none), []);
  watch.show(near, null);
  watch.show(wide, null);
  watch.spoil(7, -1); // in the wide one alone
  assert.deepEqual(watch.takeDue(none), [wide]);
  watch.spoil(0, -4);
  assert.deepEqual(watch.takeDue(new Set(["3/0/-1"])), [near], "what is being painted is not asked for again");
  assert.deepEqual(watch.takeDue(none), [wide], "but afterwards");
  assert.deepEqual(drawn, ["near", "wide"]);
});

test("while held, only what was never drawn is asked for", () => {
  const none = new Set<string>();
  const watch = new TileWatch(() => {});
  const old = { level: 0, x: 0, y: 0 };
  const added = { level: 0, x: 1, y: 0 };
  watch.add(old, () => {});
  watch.takeDue(none);
  watch.show(old, null);
  watch.hold(true);
  watch.spoil(0, 0);
  watch.add(added, () => {});
  assert.deepEqual(watch.takeDue(none), [added]);
  watch.hold(false);
  assert.deepEqual(watch.takeDue(none), [old]);
  watch.remove(old);
  watch.spoil(0, 0);
  assert.deepEqual(watch.takeDue(none), []);
});
