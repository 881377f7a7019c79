// SPDX-License-Identifier: MIT
import { effect, signal } from "@preact/signals";
import { LiveSocket } from "../link/live_socket";
import { encodeHave } from "../link/wire";
import type { Phase } from "../link/robot_link";
import { robot } from "../robot";
import { palette } from "./look";
import { idleHand, type MapHand, workerHand } from "./map_hand";
import type { Answer } from "./map_jobs";
import type { ChunkNews, MapNews } from "./map_painter";
import { placeKey } from "./pyramid";
import { tileName, TileWatch } from "./tile_watch";

const AGAIN_AFTER_MS = 5000;

/**
 * The robot's map as this page has it: which chunks, and pictures of those tiles that are shown. The cells themselves are
 * with the worker. The socket is open while somebody shows the map.
 */
class MapModel {
  /** Zero until the robot has told. */
  readonly cellSize_m = signal(0);
  /** Counts what has come. */
  readonly version = signal(0);
  /** Changes when the robot has begun a new map. */
  readonly mapId = signal(0n);
  readonly chunks = new Map<number, ChunkNews>();

  private readonly users = signal(0);
  private readonly watches = new Set<TileWatch>();
  private readonly pending = new Set<string>();
  private retry = 0;
  private isFlushing = false;
  private wasLost = false;
  private hand = this.makeHand();
  private readonly socket = new LiveSocket("map", {
    opened: () => this.socket.send(encodeHave(this.mapId.value, [...this.chunks.values()])),
    binary: (bytes) => this.hand.ask({ kind: "map", bytes }),
  });

  constructor() {
    effect(() => this.openOrClose(this.users.value > 0, robot.phase.value));
    effect(() => {
      this.hand.ask({ kind: "palette", palette: palette.value });
      this.spoilAll();
    });
  }

  /** Keeps the map coming until what it gives is called. */
  use(): () => void {
    this.users.value = this.users.peek() + 1;
    return () => (this.users.value = this.users.peek() - 1);
  }

  /** For somebody who shows tiles. */
  watch(): TileWatch {
    const watch = new TileWatch(() => this.flushSoon());
    this.watches.add(watch);
    return watch;
  }

  unwatch(watch: TileWatch): void {
    this.watches.delete(watch);
  }

  private openOrClose(isUsed: boolean, phase: Phase): void {
    if (!isUsed || phase === "stranger") {
      this.socket.stop();
    } else if (phase === "up") {
      this.socket.start();
      if (this.wasLost) this.socket.reconnect(); // it may look open, and be dead
    }
    this.wasLost = phase === "lost";
  }

  private makeHand(): MapHand {
    const say = (answer: Answer) => this.hear(answer);
    try {
      return workerHand(say, () => this.startAnew(idleHand(say)));
    } catch {
      return idleHand(say);
    }
  }

  /** After the worker was lost, and all that it had. */
  private startAnew(hand: MapHand): void {
    this.hand = hand;
    this.hand.ask({ kind: "palette", palette: palette.value });
    this.pending.clear();
    this.forget(0n);
    this.socket.reconnect();
  }

  private forget(mapId: bigint): void {
    this.chunks.clear();
    this.mapId.value = mapId;
    this.spoilAll();
  }

  private hear(answer: Answer): void {
    if (answer.kind === "news") this.hearNews(answer.news);
    else if (answer.kind === "picture") this.hearPicture(answer);
    else this.retry ||= window.setTimeout(() => this.tryAgain(), AGAIN_AFTER_MS);
  }

  /** What could not be read is sent again, what could not be painted is painted again. */
  private tryAgain(): void {
    this.retry = 0;
    this.pending.clear();
    this.spoilAll();
    this.socket.reconnect();
  }

  private hearNews(news: MapNews): void {
    if (news.mapId !== this.mapId.value) this.forget(news.mapId);
    this.cellSize_m.value = news.cellSize_m;
    for (const chunk of news.chunks) {
      this.chunks.set(placeKey(chunk.x, chunk.y), chunk);
      for (const watch of this.watches) watch.spoil(chunk.x, chunk.y);
    }
    ++this.version.value;
    this.flushSoon();
  }

  private hearPicture({ tile, picture }: Answer & { kind: "picture" }): void {
    this.pending.delete(tileName(tile));
    for (const watch of this.watches) watch.show(tile, picture);
    if (picture && "close" in picture) picture.close();
    this.flushSoon();
  }

  private spoilAll(): void {
    for (const watch of this.watches) watch.spoilAll();
    this.flushSoon();
  }

  /** Once a frame, so not at all while nobody looks at the tab. */
  private flushSoon(): void {
    if (this.isFlushing) return;
    this.isFlushing = true;
    requestAnimationFrame(() => this.flush());
  }

  private flush(): void {
    this.isFlushing = false;
    const tiles = [...this.watches].flatMap((watch) => {
      const due = watch.takeDue(this.pending);
      for (const tile of due) this.pending.add(tileName(tile));
      return due;
    });
    if (tiles.length > 0) this.hand.ask({ kind: "paint", tiles });
  }
}

export const mapModel = new MapModel();
