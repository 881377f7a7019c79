// SPDX-License-Identifier: MIT

/** The robot answered, and would not. */
export class Refused extends Error {
  constructor(
    readonly status: number,
    message: string,
  ) {
    super(message);
  }
}

/** The robot did not answer. */
export class NoAnswer extends Error {}

const PATIENCE_MS = 8000;

export type Headers = Record<string, string>;
type Method = "GET" | "POST" | "PUT" | "PATCH" | "DELETE";

/** Asks the robot; gives the JSON of its answer, or undefined when that has none. Throws Refused or NoAnswer. */
export async function ask<T>(method: Method, path: string, body?: unknown, patience_ms = PATIENCE_MS, headers: Headers = {}): Promise<T> {
  const answer = await request(method, path, body, patience_ms, headers);
  if (answer.status === 204) return undefined as T;
  const text = await answer.text().catch(() => "");
  const json = parse(text);
  if (!answer.ok) throw new Refused(answer.status, errorIn(json) ?? answer.statusText);
  return json as T;
}

async function request(method: Method, path: string, body: unknown, patience_ms: number, headers: Headers): Promise<Response> {
  const patience = new AbortController();
  const timer = setTimeout(() => patience.abort(), patience_ms);
  try {
    return await fetch(path, {
      method,
      cache: "no-store",
      keepalive: true, // a STOP goes out though the page is closed
      signal: patience.signal,
      headers: { ...headers, ...(body === undefined ? {} : { "Content-Type": "application/json" }) },
      ...(body === undefined ? {} : { body: JSON.stringify(body) }),
    });
  } catch {
    throw new NoAnswer();
  } finally {
    clearTimeout(timer);
  }
}

function parse(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    return undefined;
  }
}

function errorIn(json: unknown): string | undefined {
  return typeof json === "object" && json !== null && "error" in json && typeof json.error === "string" ? json.error : undefined;
}
