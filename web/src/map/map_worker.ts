// SPDX-License-Identifier: MIT
/** Unpacks and paints the map beside the page's thread. */
import { type Answer, doJob, type Job } from "./map_jobs";
import { MapPainter, type Pixels, type Tile, TILE_SIDE } from "./map_painter";

const painter = new MapPainter();

function say(answer: Answer, transfer: Transferable[] = []): void {
  postMessage(answer, { transfer });
}

function paintedTo(tile: Tile, pixels: Pixels | null): void {
  if (!pixels) return say({ kind: "picture", tile, picture: null });
  const data = new ImageData(pixels, TILE_SIDE, TILE_SIDE);
  const sayData = () => say({ kind: "picture", tile, picture: data }, [pixels.buffer]);
  if (typeof createImageBitmap !== "function") return sayData();
  createImageBitmap(data).then((picture) => say({ kind: "picture", tile, picture }, [picture]), sayData);
}

self.onmessage = (event: MessageEvent<Job>) => doJob(painter, event.data, { say, paintedTo });
