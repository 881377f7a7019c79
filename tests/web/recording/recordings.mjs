// SPDX-License-Identifier: MIT
// Recordings by the real program, read with the packages that others read them with.
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import rosmsg from "@foxglove/rosmsg";
import ros2 from "@foxglove/rosmsg2-serialization";
import { decompress } from "fzstd";

const top = fileURLToPath(new URL("../../../", import.meta.url));
export const dynslam = process.env.DYNSLAM_BINARY ?? join(top, "build/release/src/dynslam");
const decompressHandlers = { zstd: (bytes) => decompress(bytes) };

/** A folder that is gone when the tests of the file are over. */
export function temporaryFolder() {
  const folder = mkdtempSync(join(tmpdir(), "dynslam-test-"));
  process.on("exit", () => rmSync(folder, { recursive: true, force: true }));
  return folder;
}

/** Runs the program to its end; returns what it printed. Throws where it fails. */
export const run = (...args) => execFileSync(dynslam, args, { encoding: "utf8" });

export const start = (...args) => spawn(dynslam, args, { stdio: "ignore" });

const readerOf = (schema) =>
  new ros2.MessageReader(rosmsg.parse(new TextDecoder().decode(schema.data), { ros2: true }));

/** All messages decoded, in the order of the file, read from its front as far as it goes. */
export function readStream(path) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(readFileSync(path));
  const found = { messages: [], metadata: [], schemas: new Map(), done: false };
  const readers = new Map();
  const channels = new Map();
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Schema") {
      found.schemas.set(record.id, record);
      readers.set(record.id, readerOf(record));
    } else if (record.type === "Channel") {
      channels.set(record.id, record);
    } else if (record.type === "Metadata") {
      found.metadata.push(record);
    } else if (record.type === "Message") {
      const channel = channels.get(record.channelId);
      const message = readers.get(channel.schemaId).readMessage(record.data);
      found.messages.push({ topic: channel.topic, logTime: record.logTime, publishTime: record.publishTime, message });
    }
  }
  found.done = reader.done();
  found.on = (topic) => found.messages.filter((m) => m.topic === topic);
  return found;
}

export function openIndexed(path) {
  const bytes = readFileSync(path);
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size))),
  };
  return McapIndexedReader.Initialize({ readable, decompressHandlers });
}

/** Of a stamp, as the package reads it. */
export const seconds = (stamp) => stamp.sec + stamp.nsec * 1e-9;

/** A trajectory file, by stamp in nanoseconds. */
export function readTum(path) {
  const lines = readFileSync(path, "utf8").split("\n").filter((line) => line && !line.startsWith("#"));
  return lines.map((line) => {
    const [t, x, y, , , , qz, qw] = line.split(" ").map(Number);
    return { t, x, y, yaw: 2 * Math.atan2(qz, qw) };
  });
}

const pose = ({ translation, rotation }) => ({
  x: translation.x,
  y: translation.y,
  yaw: 2 * Math.atan2(rotation.z, rotation.w),
});

/** map -> odom -> base_link of a message on /tf. */
export function mapPose(message) {
  const at = (parent, child) => {
    const found = message.transforms.find((t) => t.header.frame_id === parent && t.child_frame_id === child);
    return pose(found.transform);
  };
  const a = at("map", "odom");
  const b = at("odom", "base_link");
  const [c, s] = [Math.cos(a.yaw), Math.sin(a.yaw)];
  return {
    t: seconds(message.transforms[0].header.stamp),
    x: a.x + c * b.x - s * b.y,
    y: a.y + s * b.x + c * b.y,
    yaw: a.yaw + b.yaw,
  };
}

export const turnBetween = (a, b) => Math.abs(Math.atan2(Math.sin(a - b), Math.cos(a - b)));
