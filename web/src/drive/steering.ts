// SPDX-License-Identifier: MIT
import { signal } from "@preact/signals";
import { ask } from "../link/http";
import type { Twist } from "../link/types";
import { CENTRED, isCentred, twistOf, type SpeedLimits, type Stick } from "./stick";

export type Source = "joystick" | "keys" | "gamepad";

const CAREFUL: SpeedLimits = { speed_mps: 0.5, turn_radps: 1.5 };

/**
 * Of all that could steer, what was moved last. When the page loses the driver's attention everything stands at
 * once, and each source has to come back to its middle before it counts again.
 */
export class Steering {
  /** What is asked for now, for showing. */
  readonly stick = signal<Stick>(CENTRED);
  private limits = CAREFUL;
  private sticks = new Map<Source, Stick>();
  private held = new Set<Source>();
  private active: Source | null = null;

  constructor(private readonly drive: (twist: Twist) => void) {}

  set(source: Source, stick: Stick): void {
    if (isCentred(stick)) this.held.delete(source);
    this.sticks.set(source, stick);
    const still = isCentred(stick) || this.held.has(source);
    if (!still) this.active = source;
    else if (this.active === source) this.active = this.another();
    this.apply();
  }

  /** Stands still, whatever is pushed. */
  release(): void {
    for (const [source, stick] of this.sticks) if (!isCentred(stick)) this.held.add(source);
    this.active = null;
    this.apply();
  }

  /** How fast the robot can go; until that is known, carefully. */
  async learnLimits(): Promise<void> {
    try {
      const config = await ask<{ kinematics?: { max_speed_mps?: number; max_turn_radps?: number } }>("GET", "api/v1/config");
      this.limits = {
        speed_mps: config.kinematics?.max_speed_mps ?? CAREFUL.speed_mps,
        turn_radps: config.kinematics?.max_turn_radps ?? CAREFUL.turn_radps,
      };
    } catch {
      this.limits = CAREFUL;
    }
  }

  /** Calls release() whenever nobody can be minding the robot any more. */
  watchAttention(): void {
    const release = () => this.release();
    window.addEventListener("blur", release);
    window.addEventListener("pagehide", release);
    document.addEventListener("visibilitychange", release);
    screen.orientation?.addEventListener("change", release);
  }

  private another(): Source | null {
    for (const [source, stick] of this.sticks) if (!isCentred(stick) && !this.held.has(source)) return source;
    return null;
  }

  private apply(): void {
    const stick = this.active ? (this.sticks.get(this.active) ?? CENTRED) : CENTRED;
    const before = this.stick.peek();
    if (stick.ahead !== before.ahead || stick.left !== before.left) this.stick.value = stick;
    this.drive(twistOf(stick, this.limits));
  }
}
