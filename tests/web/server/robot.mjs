// SPDX-License-Identifier: MIT
// Runs the real program for a test, and clients that are not ours against it.
import { spawn } from "node:child_process";
import { once } from "node:events";
import net from "node:net";
import { fileURLToPath } from "node:url";
import { WebSocket } from "ws";

const root = fileURLToPath(new URL("../../../", import.meta.url));
export const binary = process.env.DYNSLAM ?? `${root}build/release/src/dynslam`;

export const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** Waits until `get()` gives something, and gives that. */
export async function until(get, what, ms = 10000) {
  const end = Date.now() + ms;
  for (;;) {
    const value = await get();
    if (value) return value;
    if (Date.now() > end) throw new Error(`waited ${ms} ms for ${what}`);
    await sleep(20);
  }
}

export class Robot {
  /** A simulated robot that waits for a driver, on a free port. */
  static start(...args) {
    return Robot.launch(binary, "sim", ...(args.includes("--port") ? [] : ["--port", "0"]), ...args).serves();
  }

  static launch(program, ...args) {
    const robot = new Robot();
    robot.began = performance.now();
    robot.process = spawn(program, args, { stdio: ["ignore", "pipe", "pipe"] });
    robot.output = "";
    for (const stream of [robot.process.stdout, robot.process.stderr])
      stream.on("data", (text) => { robot.output += text; });
    robot.ended = once(robot.process, "exit");
    return robot;
  }

  async serves() {
    const [, port] = await until(() => /http:\/\/\S*?:(\d+)\//.exec(this.output) ??
      (this.process.exitCode !== null && Promise.reject(new Error(this.output))), "the address");
    this.port = Number(port);
    this.url = `http://127.0.0.1:${port}`;
    this.host = `127.0.0.1:${port}`;
    this.startMs = performance.now() - this.began;
    return this;
  }

  async stop(signal = "SIGTERM") {
    this.process.kill(signal);
    const [code] = await this.ended;
    return code;
  }

  fetch(path, options) { return fetch(this.url + path, options); }
  post(path, body, headers = {}) {
    return this.fetch(path, {
      method: "POST",
      headers: { ...(body === undefined ? {} : { "content-type": "application/json" }), ...headers },
      body: body === undefined ? undefined : JSON.stringify(body),
    });
  }
  async json(path) { return (await this.fetch(path)).json(); }
  /** A figure of /metrics, 0 when it is not there. */
  async metric(name) {
    const text = await (await this.fetch("/metrics")).text();
    const line = text.split("\n").find((l) => l.startsWith(name + " "));
    return line ? Number(line.slice(name.length + 1)) : 0;
  }
  event(name) { return this.metric(`dynslam_events_total{event="${name}"}`); }

  socket(kind, options = {}) { return new WebSocket(`ws://${this.host}/api/v1/ws/${kind}`, options); }
  async open(kind, options) {
    const socket = this.socket(kind, options);
    const inbox = (socket.inbox = []);
    socket.on("message", (data, binary) => inbox.push(binary ? data : JSON.parse(data)));
    socket.on("close", (code, reason) => { socket.closedWith = { code, reason: String(reason) }; });
    socket.on("error", () => {});
    await Promise.race([once(socket, "open"), once(socket, "close").then(() => { throw new Error(`no ${kind}`); })]);
    return socket;
  }
  /** Bytes as they are, without any client's help. */
  async raw(bytes = "") {
    const socket = net.connect(this.port, "127.0.0.1");
    socket.on("error", () => {});
    await once(socket, "connect");
    if (bytes) socket.write(bytes);
    return socket;
  }
  /** What comes back for a raw request, until the robot closes. */
  async rawAnswer(bytes) {
    const socket = await this.raw(bytes);
    let text = "";
    socket.on("data", (data) => { text += data.toString("latin1"); });
    await once(socket, "close");
    return text;
  }
}

/** Somebody who holds the wheel, and beats the heart every 50 ms. */
export class Driver {
  static async take(robot) {
    const driver = new Driver();
    driver.robot = robot;
    driver.socket = await robot.open("control");
    driver.wish = { v: 0, w: 0 };
    driver.seq = 0;
    driver.sentAt = new Map();
    driver.roundTrips = [];
    driver.motorDelays = [];
    driver.socket.on("message", (data) => driver.hear(JSON.parse(data)));
    driver.socket.send('{"lease":"acquire"}');
    await until(() => driver.socket.inbox.some((m) => m.wheel?.mine), "the wheel");
    driver.timer = setInterval(() => driver.beat(), 50).unref();  // a test that failed must end
    return driver;
  }
  beat() {
    this.sentAt.set(++this.seq, performance.now());
    this.socket.send(JSON.stringify({ seq: this.seq, ...this.wish }));
  }
  hear(message) {
    if (message.ack === undefined) return;
    this.last = message;
    this.roundTrips.push(performance.now() - this.sentAt.get(message.ack));
    this.sentAt.delete(message.ack);
    if (message.driven) this.motorDelays.push(message.driven.ms);
  }
  async drives() {
    await until(() => this.last && !["stop", "e-stop"].includes(this.last.motion), `leave to drive: ${this.robot.output}`);
  }
  /** Leaves without a word. */
  drop() {
    clearInterval(this.timer);
    this.socket.terminate();
  }
  async leave() {
    clearInterval(this.timer);
    this.socket.close();
    await once(this.socket, "close");
  }
}

export function spread(values) {
  const sorted = [...values].sort((a, b) => a - b);
  const at = (share) => sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] ?? NaN;
  return { n: sorted.length, p50: at(0.5), p90: at(0.9), p99: at(0.99), max: at(1) };
}
export const spreadText = (s) =>
  `n ${s.n}, p50 ${s.p50.toFixed(1)}, p90 ${s.p90.toFixed(1)}, p99 ${s.p99.toFixed(1)}, max ${s.max.toFixed(1)} ms`;
