// SPDX-License-Identifier: MIT
import { useEffect, useRef, useState } from "preact/hooks";
import { ask, NoAnswer, Refused } from "../link/http";
import { robot } from "../robot";
import { strings } from "../strings";

/** Why the robot did not do what it was asked, in one sentence. */
export function whyNot(error: unknown): string {
  if (error instanceof NoAnswer) return strings.noAnswer;
  return error instanceof Error ? error.message : String(error);
}

/** What the robot answers to a request; null after it refused, which is shown. */
export async function answerTo<T>(method: "GET" | "POST" | "PATCH", path: string, body?: unknown): Promise<T | null> {
  try {
    return await ask<T>(method, path, body);
  } catch (error) {
    robot.onTrouble(whyNot(error));
    return null;
  }
}

/** Whether who uses this page may do what takes a driver or an admin. */
export function may(needed: "driver" | "admin"): boolean {
  const role = robot.me.value?.role;
  return role === "admin" || role === needed;
}

export interface Asked<T> {
  /** What the robot said last; null before. */
  value: T | null;
  /** When it said so, by performance.now(). */
  at_ms: number;
  /** Why there is nothing newer; null when there is. */
  trouble: string | null;
  again: () => void;
}

/** Asks for `path` at once, and then every `every_ms` while this is shown and seen. */
export function useAsked<T>(path: string, every_ms?: number): Asked<T> {
  const [got, setGot] = useState<Omit<Asked<T>, "again">>({ value: null, at_ms: 0, trouble: null });
  const again = useRef(() => {});
  useEffect(() => {
    let timer = 0;
    let over = false;
    let round = 0; // an answer that comes after another was asked for is not looked at
    const next = async () => {
      clearTimeout(timer);
      const mine = ++round;
      if (over) return;
      if (!document.hidden) await look(mine);
      if (mine === round && every_ms !== undefined) timer = window.setTimeout(() => void next(), every_ms);
    };
    const look = async (mine: number) => {
      try {
        const value = await ask<T>("GET", path);
        if (mine === round) setGot({ value, at_ms: performance.now(), trouble: null });
      } catch (error) {
        const trouble = error instanceof Refused && error.status === 404 ? strings.more.notThere : whyNot(error);
        if (mine === round) setGot((before) => ({ ...before, trouble }));
      }
    };
    again.current = () => void next();
    void next();
    return () => {
      over = true;
      round++;
      clearTimeout(timer);
    };
  }, [path, every_ms]);
  return { ...got, again: () => again.current() };
}
