// SPDX-License-Identifier: MIT
import type { Twist } from "./types";

export const BEAT_MS = 50;
/** A change is sent at once, but never faster than this: the server takes 60 messages a second. */
const LEAST_GAP_MS = 20;
/** With answers later than this nobody can steer: commands that wait somewhere would be obeyed when they come. */
const LATE_MS = 200;
export const STILL: Twist = { v: 0, w: 0 };

const isStill = (twist: Twist) => twist.v === 0 && twist.w === 0;

/**
 * Says every 50 ms what the driver wants, standing still too: the robot stops when it hears nothing for 200 ms. To
 * stand still is said at once, whatever was said just before.
 */
export class Heartbeat {
  private wish = STILL;
  private seq: number;
  private sent_ms = -Infinity;
  private sentAt = new Map<number, number>(); // of what is not acknowledged yet
  private timer = 0;
  /** Answers came late, and the driver has not let go since. */
  private isLate = false;

  /** Numbers go up from a random one, so that two pages are told apart in a recording. */
  constructor(
    private readonly send: (message: string) => boolean,
    private readonly now_ms: () => number = () => performance.now(),
  ) {
    this.seq = Math.floor(Math.random() * 2 ** 30);
  }

  start(): void {
    this.timer ||= setInterval(() => this.beat(), BEAT_MS) as unknown as number;
  }

  /** Says once more to stand still, and then nothing. */
  stop(): void {
    if (!this.timer) return;
    clearInterval(this.timer);
    this.timer = 0;
    this.wish = STILL;
    this.beat();
    this.sentAt.clear();
  }

  want(twist: Twist): void {
    const changed = twist.v !== this.wish.v || twist.w !== this.wish.w;
    this.wish = twist;
    if (this.timer && changed && (isStill(twist) || this.now_ms() - this.sent_ms >= LEAST_GAP_MS)) this.beat();
  }

  /** How long the robot's answer to message `seq` took, milliseconds; null for one that is not known. */
  answered(seq: number): number | null {
    const sent = this.sentAt.get(seq);
    for (const earlier of this.sentAt.keys()) if (earlier <= seq) this.sentAt.delete(earlier);
    return sent === undefined ? null : this.now_ms() - sent;
  }

  /** How long the oldest message has waited for its answer; 0 when none does. */
  waiting_ms(): number {
    for (const sent of this.sentAt.values()) return this.now_ms() - sent;
    return 0;
  }

  private beat(): void {
    if (this.waiting_ms() > LATE_MS) this.isLate = true;
    else if (isStill(this.wish)) this.isLate = false;
    const wish = this.isLate ? STILL : this.wish;
    const seq = ++this.seq;
    if (!this.send(JSON.stringify({ seq, v: wish.v, w: wish.w }))) return;
    this.sent_ms = this.now_ms();
    this.sentAt.set(seq, this.sent_ms);
    if (this.sentAt.size > 200) this.sentAt.delete(this.sentAt.keys().next().value!);
  }
}
