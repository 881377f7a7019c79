// SPDX-License-Identifier: MIT

const WINDOW_MS = 30000;

/**
 * How old what the robot says is, whatever the clocks of both show. Of all messages lately, the one that came fastest
 * tells how far the clocks are apart; so ages leave out the shortest way there is, a millisecond or a few.
 */
export class RobotClock {
  private offset_ms: [number, number] = [Infinity, Infinity]; // of this window and the one before
  private windowEnds_ms = -Infinity;

  /** A message of the robot's time `t_s` came at `now_ms` of performance.now(). */
  hear(t_s: number, now_ms: number): void {
    if (now_ms >= this.windowEnds_ms) {
      this.offset_ms = [Infinity, this.offset_ms[0]];
      this.windowEnds_ms = now_ms + WINDOW_MS;
    }
    const offset_ms = now_ms - 1000 * t_s;
    // A robot whose clock began anew is another robot.
    if (Math.abs(offset_ms - this.best()) > WINDOW_MS) this.offset_ms = [offset_ms, Infinity];
    this.offset_ms[0] = Math.min(this.offset_ms[0], offset_ms);
  }

  /** Milliseconds since the robot's time `t_s`; never negative; null before anything was heard. */
  age_ms(t_s: number, now_ms: number): number | null {
    const best = this.best();
    return Number.isFinite(best) ? Math.max(0, now_ms - 1000 * t_s - best) : null;
  }

  private best(): number {
    return Math.min(...this.offset_ms);
  }
}
