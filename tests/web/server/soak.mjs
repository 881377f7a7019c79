// SPDX-License-Identifier: MIT
// Clients come, go and attack for a while, and memory must not grow: node server/soak.mjs SECONDS [MIB]. DYNSLAM names
// the program, one with sanitizers most likely; MIB is how much more it may hold at the end than when it was warm.
// Exit 1 when it grew, died or did not end well.
import { spawn } from "node:child_process";
import { once } from "node:events";
import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { Driver, Robot, sleep, spread, spreadText } from "./robot.mjs";

const seconds = Number(process.argv[2] ?? 60), mostMib = Number(process.argv[3] ?? 16);
const script = fileURLToPath(new URL("attacker.mjs", import.meta.url));
const robot = await Robot.start("--world", "apartment");
const status = () => readFileSync(`/proc/${robot.process.pid}/status`, "utf8");
const mib = () => Number(/VmRSS:\s*(\d+)/.exec(status())[1]) / 1024;
const threads = () => Number(/Threads:\s*(\d+)/.exec(status())[1]);

const attacker = spawn(process.execPath, [script, String(robot.port), String(seconds), String(Date.now() % 1000)],
  { stdio: ["ignore", "pipe", "inherit"] });
let did = "";
attacker.stdout.on("data", (text) => { did += text; });
const delays = [];
let over = false;
const driving = (async () => {
  while (!over && robot.process.exitCode === null) {
    const driver = await Driver.take(robot).catch(() => null);
    if (!driver) { await sleep(500); continue; }
    driver.wish = { v: 0, w: 0 };
    await sleep(1000);
    driver.wish = { v: 0.15, w: 0.8 };
    await sleep(4000);
    delays.push(...driver.motorDelays);
    driver.drop();
  }
})();

const warm = Math.min(60, seconds / 3), samples = [];
for (let second = 1; second <= seconds && robot.process.exitCode === null; ++second) {
  await sleep(1000);
  samples.push(mib());
  if (second % 60 === 0 || second === seconds) console.log(`${second} s: ${samples.at(-1).toFixed(0)} MiB, ${threads()} threads`);
}
over = true;
await Promise.race([driving, sleep(15000)]);
if (attacker.exitCode === null) await once(attacker, "exit");
console.log(`attacks: ${did.trim()}`);
console.log(`command to motor: ${spreadText(spread(delays))}`);

// The least of a stretch is what is held; the rest comes and goes with the clients.
const part = samples.slice(Math.floor(warm)), third = Math.max(1, Math.floor(part.length / 3));
const early = Math.min(...part.slice(0, third)), late = Math.min(...part.slice(-third));
console.log(`held when warm ${early.toFixed(1)} MiB, at the end ${late.toFixed(1)} MiB`);
const died = robot.process.exitCode !== null;
const code = died ? robot.process.exitCode : await robot.stop();
if (died || code !== 0) console.log(`the program ended with ${code}:\n${robot.output.slice(-5000)}`);
process.exit(died || code !== 0 || late - early > mostMib ? 1 : 0);
