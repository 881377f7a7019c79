// SPDX-License-Identifier: MIT
import { type Answer, doJob, type Job } from "./map_jobs";
import { MapPainter, TILE_SIDE } from "./map_painter";

/** Who paints the map. */
export interface MapHand {
  ask(job: Job): void;
}

/** A worker; throws where there are none. `failed` when it does not start, or falls over: all that it had is lost. */
export function workerHand(say: (answer: Answer) => void, failed: () => void): MapHand {
  const worker = new Worker(new URL("map_worker.js", document.baseURI));
  worker.onmessage = (event: MessageEvent<Answer>) => say(event.data);
  worker.onerror = () => {
    worker.terminate();
    failed();
  };
  return { ask: (job) => worker.postMessage(job, job.kind === "map" ? [job.bytes] : []) };
}

const SLICE_MS = 8;

/** The page's own thread, a little at a time when it has nothing better to do. */
export function idleHand(say: (answer: Answer) => void, later: (work: () => void) => void = whenIdle): MapHand {
  const painter = new MapPainter();
  const jobs: Job[] = [];
  const work = () => {
    const until_ms = performance.now() + SLICE_MS;
    while (jobs.length > 0 && performance.now() < until_ms)
      doJob(painter, jobs.shift()!, {
        say,
        paintedTo: (tile, pixels) => say({ kind: "picture", tile, picture: pixels && new ImageData(pixels, TILE_SIDE, TILE_SIDE) }),
      });
    if (jobs.length > 0) later(work);
  };
  return {
    ask(job) {
      if (jobs.length === 0) later(work);
      if (job.kind === "paint") jobs.push(...job.tiles.map((tile): Job => ({ kind: "paint", tiles: [tile] })));
      else jobs.push(job);
    },
  };
}

function whenIdle(work: () => void): void {
  if (typeof requestIdleCallback === "function") requestIdleCallback(work, { timeout: 200 });
  else setTimeout(work, 4);
}
