// SPDX-License-Identifier: MIT
import type { Condition } from "./advice";

/** Its shape tells as much as its colour. */
const SHAPES: Record<Condition, string> = {
  good: "M10 1a9 9 0 1 0 .01 0zM5.5 10.3l3 3 6-6.3", // a tick in a circle
  trouble: "M10 1.5 19 18H1zM10 7v5.5M10 14.6v1.2", // a triangle that calls
  silent: "M2 2h16v16H2zM6 6l8 8M14 6l-8 8", // a crossed square
  absent: "M10 1.5 18.5 10 10 18.5 1.5 10zM6 10h8", // a rhombus with a dash
  resting: "M10 1a9 9 0 1 0 .01 0zM7.5 6.5v7M12.5 6.5v7", // a pause
};

export function ConditionMark({ condition }: { condition: Condition }) {
  return (
    <svg class="mark" viewBox="0 0 20 20" width="20" height="20" aria-hidden="true">
      <path d={SHAPES[condition]} />
    </svg>
  );
}
