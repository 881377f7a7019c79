// SPDX-License-Identifier: MIT
import { signal } from "@preact/signals";
import { Heartbeat } from "./heartbeat";
import { ask, type Headers, NoAnswer, Refused } from "./http";
import { LiveSocket } from "./live_socket";
import { RobotClock } from "./robot_clock";
import type { Me, State, Twist, Wheel } from "./types";

/** Whether the robot is heard: `stranger` is answered, but has to pair first. */
export type Phase = "connecting" | "up" | "lost" | "stranger";

const LOOK_EVERY_MS = 200;
const SILENT_AFTER_MS = 1000;
const DEAD_AFTER_MS = 3000;
/** STOP is asked for again and again, each time with little patience. */
const STOP_FOR_MS = 20000;
const STOP_PATIENCE_MS = 1500;
const NOBODY: Wheel = { mine: false, driver: null };

/** What comes down the control socket, see wire.md. */
interface ControlMessage {
  ack?: number;
  driven?: { seq: number; ms: number } | null;
  t_s?: number;
  wheel?: Wheel;
  error?: string;
}

/**
 * The page's connection to the robot: what it says about itself, and the wheel. Everything that is shown is a signal.
 * Comes back by itself after the network was lost, the robot started anew, or the tab slept.
 */
export class RobotLink {
  readonly phase = signal<Phase>("connecting");
  readonly me = signal<Me | null>(null);
  readonly state = signal<State | null>(null);
  readonly wheel = signal<Wheel>(NOBODY);
  /** From a command to its acknowledgement, milliseconds; null while nothing is driven. */
  readonly delay_ms = signal<number | null>(null);
  /** From when the robot heard a command to when the motors had it, as the robot says. */
  readonly motor_ms = signal<number | null>(null);
  /** Whether this page would drive if it could: the wheel is taken when it is free. */
  readonly wantsWheel = signal(true);
  /** STOP was pressed, and the robot has not said that it heard. */
  readonly isStopUnheard = signal(false);
  readonly clock = new RobotClock();
  /** Told of what the robot would not do, in its words; of null when it could not be asked. */
  onTrouble: (why: string | null) => void = () => {};
  /** Told whenever there is a new connection: what was held of the robot may be of an earlier run. */
  onUp: () => void = () => {};

  private readonly heartbeat = new Heartbeat((message) => this.control.send(message));
  private readonly control = new LiveSocket("control", {
    text: (message) => this.hearControl(message as ControlMessage),
    closed: () => this.letGo(),
  });
  private readonly states = new LiveSocket("state", {
    opened: () => {
      this.heard_ms = performance.now();
      void this.ask_who();
    },
    text: (message) => this.hearState(message as State),
    closed: () => void this.ask_who(),
  });
  /** Whether the robot has said who has the wheel. */
  private knowsWheel = false;
  private heard_ms = 0;
  private asking: Promise<void> | null = null;

  start(): void {
    this.heard_ms = performance.now();
    this.control.start();
    this.states.start();
    setInterval(() => this.look(), LOOK_EVERY_MS);
    document.addEventListener("visibilitychange", () => this.wake());
    window.addEventListener("online", () => this.reconnect());
    window.addEventListener("pagehide", () => this.heartbeat.stop());
    window.addEventListener("pageshow", (event) => event.persisted && this.reconnect());
    void this.ask_who();
  }

  get mayDrive(): boolean {
    const role = this.me.value?.role;
    return role === "driver" || role === "admin";
  }

  /** What this page's driver wants; nothing unless it holds the wheel. */
  drive(twist: Twist): void {
    this.heartbeat.want(twist);
  }

  /** Stops the robot, on every way there is; needs no login and no wheel. */
  stop(): void {
    this.heartbeat.want({ v: 0, w: 0 });
    this.control.send('{"stop":true}');
    void this.stopUntilHeard(performance.now() + STOP_FOR_MS);
  }

  /** Who pressed STOP while the network was away means it still. */
  private async stopUntilHeard(until_ms: number): Promise<void> {
    for (;;) {
      try {
        await ask("POST", "api/v1/stop", undefined, STOP_PATIENCE_MS);
        this.isStopUnheard.value = false;
        return;
      } catch (error) {
        if (error instanceof Refused || performance.now() > until_ms) {
          this.isStopUnheard.value = false;
          return this.onTrouble(error instanceof Refused ? error.message : null);
        }
      }
      this.isStopUnheard.value = true;
      this.control.send('{"stop":true}');
      await new Promise((resolve) => setTimeout(resolve, LOOK_EVERY_MS));
    }
  }

  takeWheel(fromSomebody: boolean): void {
    this.wantsWheel.value = true;
    this.control.send(JSON.stringify({ lease: fromSomebody ? "take_over" : "acquire" }));
  }

  releaseWheel(): void {
    this.wantsWheel.value = false;
    this.heartbeat.stop();
    this.control.send('{"lease":"release"}');
  }

  /** Asks the robot for something; whether it did it. What it says against it is shown. */
  async asked(method: "POST" | "PUT" | "PATCH" | "DELETE", path: string, body?: unknown, headers?: Headers): Promise<boolean> {
    try {
      await ask(method, path, body, undefined, headers);
      return true;
    } catch (error) {
      this.onTrouble(error instanceof Refused ? error.message : null);
      return false;
    }
  }

  /** After this browser was paired, or has left. */
  async meet(): Promise<void> {
    await this.asking; // what is asked already may be answered as before
    await this.ask_who();
    this.reconnect();
  }

  private reconnect(): void {
    this.control.reconnect();
    this.states.reconnect();
  }

  private ask_who(): Promise<void> {
    this.asking ??= this.hearWho().finally(() => (this.asking = null));
    return this.asking;
  }

  private async hearWho(): Promise<void> {
    try {
      this.me.value = await ask<Me>("GET", "api/v1/me");
      if (this.me.value.role === "none") this.phase.value = "stranger";
      else if (this.phase.value === "stranger") this.phase.value = "connecting";
      this.grasp();
    } catch (error) {
      if (!(error instanceof NoAnswer)) this.onTrouble((error as Error).message);
    }
  }

  /** Takes the wheel if it is free; a page that nobody looks at has no use for it. */
  private grasp(): void {
    if (!this.wantsWheel.value || !this.mayDrive || document.hidden) return;
    if (this.knowsWheel && this.wheel.value.driver === null) this.control.send('{"lease":"acquire"}');
  }

  private letGo(): void {
    this.knowsWheel = false;
    this.heartbeat.stop();
    this.wheel.value = NOBODY;
    this.delay_ms.value = this.motor_ms.value = null;
  }

  private hearControl(message: ControlMessage): void {
    if (message.wheel) this.hearWheel(message.wheel);
    if (message.ack !== undefined) this.delay_ms.value = this.heartbeat.answered(message.ack) ?? this.delay_ms.value;
    if (message.driven) this.motor_ms.value = message.driven.ms;
    if (message.error) this.onTrouble(message.error);
  }

  private hearWheel(wheel: Wheel): void {
    const had = this.wheel.value.mine;
    this.knowsWheel = true;
    this.wheel.value = wheel;
    if (wheel.mine) {
      this.heartbeat.start();
    } else {
      this.heartbeat.stop();
      this.delay_ms.value = this.motor_ms.value = null;
      if (had && wheel.driver !== null) this.wantsWheel.value = false; // taken over: not to be torn to and fro
      this.grasp();
    }
  }

  private hearState(state: State): void {
    this.heard_ms = performance.now();
    this.clock.hear(state.t_s, this.heard_ms);
    this.state.value = state;
    if (this.phase.value === "up") return;
    this.phase.value = "up";
    this.onUp();
  }

  /** A connection may be dead and not know it. */
  private look(): void {
    const silent_ms = performance.now() - this.heard_ms;
    if (this.phase.value === "up" && silent_ms > SILENT_AFTER_MS) this.phase.value = "lost";
    if (this.wheel.value.mine && this.heartbeat.waiting_ms() > SILENT_AFTER_MS) this.control.reconnect();
    if (silent_ms > DEAD_AFTER_MS && this.states.isOpen) {
      this.heard_ms = performance.now();
      this.reconnect();
    }
  }

  /** Nobody drives with a page that is not seen. */
  private wake(): void {
    if (document.hidden) {
      this.heartbeat.stop();
      this.control.send('{"lease":"release"}');
    } else if (performance.now() - this.heard_ms > SILENT_AFTER_MS) {
      this.reconnect();
    } else {
      this.grasp();
    }
  }
}
