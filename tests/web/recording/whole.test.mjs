// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { join } from "node:path";
import { before, describe, it } from "node:test";

import { mapPose, openIndexed, readStream, readTum, run, seconds, temporaryFolder, turnBetween } from "./recordings.mjs";

const kSeconds = 25;
const kTypes = {
  "/scan": "sensor_msgs/msg/LaserScan",
  "/imu": "sensor_msgs/msg/Imu",
  "/odom": "nav_msgs/msg/Odometry",
  "/battery": "sensor_msgs/msg/BatteryState",
  "/cmd_vel": "geometry_msgs/msg/TwistStamped",
  "/cmd_vel_applied": "geometry_msgs/msg/TwistStamped",
  "/tf": "tf2_msgs/msg/TFMessage",
  "/tf_static": "tf2_msgs/msg/TFMessage",
  "/map": "nav_msgs/msg/OccupancyGrid",
  "/camera/compressed": "sensor_msgs/msg/CompressedImage",
  "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
  "/rosout": "rcl_interfaces/msg/Log",
};

describe("a recording", () => {
  const out = temporaryFolder();
  let recording, live;

  before(() => {
    run("sim", "--headless", "--speed", "0", "--duration", `${kSeconds}`, "--out", out, "--set", "recorder.camera=true");
    recording = readStream(join(out, "recording.mcap"));
    live = readTum(join(out, "trajectory_live.tum"));
  });

  it("is whole, and has every topic with its type", async () => {
    assert.ok(recording.done);
    const reader = await openIndexed(join(out, "recording.mcap"));
    const types = {};
    for (const channel of reader.channelsById.values()) {
      assert.equal(channel.messageEncoding, "cdr");
      types[channel.topic] = reader.schemasById.get(channel.schemaId).name;
    }
    assert.deepEqual(types, kTypes);
    assert.equal(reader.header.profile, "ros2");
    assert.equal(Number(reader.statistics.messageCount), recording.messages.length);
    assert.ok(reader.statistics.chunkCount >= kSeconds, "a chunk a second at least");
  });

  it("is found by its index as it is read from its front", async () => {
    const reader = await openIndexed(join(out, "recording.mcap"));
    const [from, to] = [5_000_000_000n, 7_000_000_000n];
    const found = [];
    for await (const m of reader.readMessages({ topics: ["/imu"], startTime: from, endTime: to })) found.push(m.logTime);
    const all = recording.on("/imu").filter((m) => m.logTime >= from && m.logTime <= to);
    assert.deepEqual(found, all.map((m) => m.logTime));
    assert.ok(found.length > 190);
  });

  it("tells the program's settings", () => {
    const about = recording.metadata.find((m) => m.name === "dynslam").metadata;
    assert.equal(JSON.parse(about.get("config")).slam.cell_size_m, 0.02);
  });

  it("has a scan and a pose for each line of the trajectory", () => {
    const scans = recording.on("/scan").map((m) => m.message);
    const poses = recording.on("/tf").map((m) => mapPose(m.message));
    assert.ok(Math.abs(scans.length - live.length) <= 2);
    assert.ok(live.length - poses.length <= 1 && poses.length > 200);
    poses.forEach((pose, i) => {
      assert.ok(Math.abs(pose.t - live[i].t) < 1e-6);
      assert.ok(Math.hypot(pose.x - live[i].x, pose.y - live[i].y) < 1e-5, `pose ${i}`);
      assert.ok(turnBetween(pose.yaw, live[i].yaw) < 1e-5);
      assert.equal(seconds(scans[i].header.stamp), pose.t);
    });
  });

  it("has scans of a whole turn with what is not seen as infinity", () => {
    const { message } = recording.on("/scan")[100];
    assert.equal(message.header.frame_id, "laser");
    assert.equal(message.ranges.length, 1200);
    assert.ok(Math.abs(message.angle_increment * 1200 - 2 * Math.PI) < 1e-5);
    assert.ok(Math.abs(message.time_increment * 1200 - 0.1) < 1e-6);
    assert.ok(message.ranges.every((r) => r === Infinity || (r > message.range_min && r < message.range_max)));
    const laser = recording.on("/tf_static")[0].message.transforms.find((t) => t.child_frame_id === "laser");
    assert.equal(laser.header.frame_id, "base_link");
    assert.ok(Math.abs(laser.transform.translation.z - 0.18) < 1e-9);
  });

  it("has orientations of unit length and no other claims of the IMU", () => {
    for (const { message } of recording.on("/imu")) {
      const q = message.orientation;
      assert.ok(Math.abs(Math.hypot(q.x, q.y, q.z, q.w) - 1) < 1e-9);
      assert.equal(message.angular_velocity_covariance[0], -1);
      assert.equal(message.linear_acceleration_covariance[0], -1);
    }
  });

  it("has an odometry that drives as far as the robot did", () => {
    const places = recording.on("/odom").map((m) => m.message);
    assert.equal(places[0].header.frame_id, "odom");
    assert.equal(places[0].child_frame_id, "base_link");
    let way = 0;
    let driven = 0;
    for (let i = 1; i < places.length; ++i) {
      const [a, b] = [places[i - 1].pose.pose.position, places[i].pose.pose.position];
      way += Math.hypot(b.x - a.x, b.y - a.y);
      driven += 0.1 * Math.abs(places[i].twist.twist.linear.x);
    }
    assert.ok(way > 2, `${way} m`);
    assert.ok(Math.abs(way - driven) < 0.05 * way, `${way} m, ${driven} m by its speed`);
  });

  it("has commands and what became of them", () => {
    const asked = recording.on("/cmd_vel").map((m) => m.message.twist.linear.x);
    const applied = recording.on("/cmd_vel_applied").map((m) => m.message.twist.linear.x);
    assert.ok(asked.length > 19 * kSeconds && applied.length > 49 * kSeconds);
    assert.ok(Math.max(...applied) > 0.2 && Math.max(...applied) <= Math.max(...asked) + 1e-9);
  });

  it("has maps that look like the one in the result", () => {
    const maps = recording.on("/map").map((m) => m.message);
    assert.ok(maps.length >= 3);
    const { info, data } = maps.at(-1);
    assert.equal(data.length, info.width * info.height);
    assert.ok(Math.abs(info.resolution - 0.02) < 1e-8);
    const count = (value) => data.reduce((n, cell) => n + (cell === value), 0);
    assert.ok(count(0) > 20000 && count(100) > 500);
    assert.equal(count(0) + count(100) + count(-1), data.length);
    assert.ok(info.origin.position.x < 0 && info.origin.position.y < 0);
  });

  it("has the battery, pictures, the health of each device and the log", () => {
    const { message: battery } = recording.on("/battery").at(-1);
    assert.ok(battery.voltage > 10 && battery.voltage < 15 && battery.percentage > 0 && battery.percentage <= 1);
    const pictures = recording.on("/camera/compressed").map((m) => m.message);
    assert.ok(pictures.length > 5 * kSeconds);
    for (const { format, data } of pictures) {
      assert.equal(format, "jpeg");
      assert.deepEqual([data[0], data[1], data.at(-2), data.at(-1)], [0xff, 0xd8, 0xff, 0xd9]);
    }
    const named = new Set(recording.on("/diagnostics").flatMap((m) => m.message.status.map((s) => s.name)));
    assert.deepEqual([...named].sort(), ["camera", "drive", "imu", "lidar", "motors", "pins", "recorder", "slam"]);
    assert.ok(recording.on("/rosout").some((m) => m.message.name === "drive" && m.message.msg.startsWith("go")));
  });

  it("replays to the poses that the robot had", () => {
    const again = join(out, "again");
    run("replay", join(out, "recording.mcap"), "--quiet", "--out", again);
    assert.deepEqual(readTum(join(again, "trajectory_live.tum")).slice(0, live.length), live);
  });
});

describe("a recording of a robot that drives itself", () => {
  const out = temporaryFolder();
  let recording;

  before(() => {
    run("sim", "--headless", "--speed", "0", "--world", "empty", "--mission", "goals:2", "--out", out);
    recording = readStream(join(out, "recording.mcap"));
  });

  it("tells what it is about, whenever that changes", () => {
    const lines = recording.on("/rosout").map((m) => m.message).filter((line) => line.name === "autopilot").map((line) => line.msg);
    assert.ok(lines.some((line) => line.startsWith("explores")), lines.join("\n"));
    assert.ok(lines.some((line) => /^drives, to -?\d+(\.\d{1,2})?, -?\d/.test(line)), lines.join("\n"));
    lines.slice(1).forEach((line, i) => assert.notEqual(line, lines[i]));
  });

  it("has the route as long as there is one, from the robot on", async () => {
    const reader = await openIndexed(join(out, "recording.mcap"));
    const channel = [...reader.channelsById.values()].find((c) => c.topic === "/plan");
    assert.equal(reader.schemasById.get(channel.schemaId).name, "nav_msgs/msg/Path");
    const poses = recording.on("/tf").map((m) => ({ ...mapPose(m.message), logTime: m.logTime }));
    const routes = recording.on("/plan").filter((m) => m.message.poses.length > 1);
    assert.ok(routes.length > 10);
    for (const { logTime, message } of routes) {
      assert.equal(message.header.frame_id, "map");
      const robot = poses.findLast((pose) => pose.logTime <= logTime);
      const { x, y } = message.poses[0].pose.position;
      assert.ok(Math.hypot(x - robot.x, y - robot.y) < 0.3, "it begins where the robot is");
    }
  });
});
