// SPDX-License-Identifier: MIT
import { signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { LiveSocket } from "../link/live_socket";
import { parsePicture, type Picture } from "../link/wire";
import { robot } from "../robot";
import { strings } from "../strings";

const MISSED_AFTER_MS = 2000;
/** A picture that no other follows is told of as getting old from here on. */
const STALE_AFTER_MS = 300;

/** How old the newest picture was when it was shown, milliseconds; null while there is none. */
export const videoAge_ms = signal<number | null>(null);

/** Shows pictures as they come: the newest only, each acknowledged when it is seen, so that none ever queue. */
class Player {
  private readonly socket = new LiveSocket("video", { binary: (bytes) => this.take(bytes), closed: () => this.lose() });
  private waiting: Picture | null = null;
  private busy = false;
  private missed = 0;
  private isOver = false;
  private shown: { taken_s: number; at_ms: number } | null = null;
  private readonly ageing = window.setInterval(() => this.age(), 250);

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.socket.start();
    this.expect();
  }

  end(): void {
    this.isOver = true;
    this.socket.stop();
    clearTimeout(this.missed);
    clearInterval(this.ageing);
    videoAge_ms.value = null;
  }

  private take(bytes: ArrayBuffer): void {
    this.waiting = parsePicture(bytes);
    if (!this.busy) void this.show();
  }

  private async show(): Promise<void> {
    this.busy = true;
    while (this.waiting) {
      const picture = this.waiting;
      this.waiting = null;
      try {
        await this.draw(picture);
      } catch {
        // One that cannot be decoded is passed over, and the next one asked for.
      }
      this.socket.send(JSON.stringify({ ack: picture.number }));
    }
    this.busy = false;
  }

  private async draw(picture: Picture): Promise<void> {
    const bitmap = await createImageBitmap(new Blob([picture.jpeg], { type: "image/jpeg" }));
    if (this.isOver) return bitmap.close();
    if (this.canvas.width !== bitmap.width || this.canvas.height !== bitmap.height) {
      this.canvas.width = bitmap.width;
      this.canvas.height = bitmap.height;
    }
    this.canvas.getContext("2d")?.drawImage(bitmap, 0, 0);
    bitmap.close();
    this.shown = { taken_s: picture.taken_s, at_ms: performance.now() };
    videoAge_ms.value = robot.clock.age_ms(picture.taken_s, this.shown.at_ms);
    this.expect();
  }

  private age(): void {
    const now_ms = performance.now();
    if (videoAge_ms.peek() !== null && this.shown && now_ms - this.shown.at_ms > STALE_AFTER_MS)
      videoAge_ms.value = robot.clock.age_ms(this.shown.taken_s, now_ms);
  }

  private expect(): void {
    clearTimeout(this.missed);
    this.missed = window.setTimeout(() => this.lose(), MISSED_AFTER_MS);
  }

  private lose(): void {
    videoAge_ms.value = null;
  }
}

export function Video() {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    let player: Player | null = null;
    const watch = () => {
      player?.end();
      player = document.hidden ? null : new Player(canvas.current!);
    };
    watch();
    document.addEventListener("visibilitychange", watch);
    return () => {
      document.removeEventListener("visibilitychange", watch);
      player?.end();
    };
  }, []);
  return (
    <div class="video">
      <canvas ref={canvas} role="img" aria-label={strings.drive.video} />
      <NoVideo />
    </div>
  );
}

/** An old picture that looks like a new one would be a lie. */
function NoVideo() {
  return videoAge_ms.value === null ? <p class="video-none">{strings.drive.noVideo}</p> : null;
}
