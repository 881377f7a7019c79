// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, statSync } from "node:fs";
import { join } from "node:path";
import { before, describe, it } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import { dynslam, mapPose, readStream, readTum, start, temporaryFolder } from "./recordings.mjs";

describe("a recording cut by SIGKILL", () => {
  const out = temporaryFolder();
  const path = join(out, ".recording.mcap.partial");
  let recording, life;

  before(async () => {
    const begun = performance.now();
    const robot = start("sim", "--headless", "--world", "empty", "--out", out);
    const over = new Promise((resolve) => robot.on("exit", (code, signal) => resolve(signal)));
    const written = () => (existsSync(path) ? statSync(path).size : 0);
    while (written() < 300_000 && robot.exitCode === null && performance.now() - begun < 60_000) await sleep(20);
    robot.kill("SIGKILL");
    life = (performance.now() - begun) / 1000;
    assert.equal(await over, "SIGKILL");
    recording = readStream(path);
  });

  it("opens and decodes up to the last second", (t) => {
    assert.ok(!recording.done, "it has no end mark");
    const last = Number(recording.messages.at(-1).logTime) * 1e-9;
    t.diagnostic(`killed ${life.toFixed(2)} s after its start; recorded up to ${last.toFixed(2)} s by its own clock`);
    assert.ok(recording.on("/scan").length > 20);
    assert.ok(life - last < 3, "a second, and what starting takes on a busy machine");
  });

  it("replays to the poses that the robot had", () => {
    const again = join(out, "again");
    const replay = spawnSync(dynslam, ["replay", path, "--quiet", "--out", again], { encoding: "utf8" });
    assert.equal(replay.status, 2);
    assert.match(replay.stderr, /the file ends/);
    const poses = new Map(readTum(join(again, "trajectory_live.tum")).map((p) => [p.t.toFixed(6), p]));
    const known = recording.on("/tf").map((m) => mapPose(m.message));
    assert.ok(known.length > 20);
    for (const pose of known) {
      const same = poses.get(pose.t.toFixed(6));
      assert.ok(same, `no pose at ${pose.t}`);
      assert.ok(Math.hypot(pose.x - same.x, pose.y - same.y) < 0.02, `at ${pose.t}`);
    }
  });
});
