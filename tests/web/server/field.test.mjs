// SPDX-License-Identifier: MIT
// What a robot meets in the field, as far as it can be had at a desk: its power is cut while it saves or records (it is
// killed, again and again), its state is broken or cannot be saved, there is no network yet, and its SD card wears.
import assert from "node:assert/strict";
import { execFile, execFileSync } from "node:child_process";
import { appendFileSync, copyFileSync, existsSync, lstatSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, statSync, truncateSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { isDeepStrictEqual, promisify } from "node:util";
import { binary, Robot, sleep, until } from "./robot.mjs";

const cuts = Number(process.env.POWER_CUTS ?? 30);
const folders = [], robots = [];
after(() => {
  for (const robot of robots) robot.process.kill("SIGKILL");  // of a test that failed
  for (const folder of folders) rmSync(folder, { recursive: true, force: true });
});
function newFolder() {
  folders.push(mkdtempSync(join(tmpdir(), "field-")));
  return folders.at(-1);
}

/** The same every time, 0 to 1 (mulberry32). */
function lots(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

const withState = (folder) => ["--set", `state.folder=${folder}`, "--set", `recorder.folder=${folder}/recordings`];

const launch = (...command) => robots[robots.push(Robot.launch(...command)) - 1];
/** A robot on this machine's own hardware, of which there is none. */
const starting = (folder) => launch(binary, "run", "--set", "server.port=0", ...withState(folder));
const run = (folder) => starting(folder).serves();
const recording = (folder) => launch(binary, "sim", "--port", "0", "--set", "recorder.always=true",
  "--set", `recorder.folder=${folder}`, "--set", "recorder.free_floor_mib=0").serves();

/** Pairs with the code that is on the console, and makes a token for what follows. */
async function own(robot) {
  const [, code] = await until(() => /code (\S+) becomes/.exec(robot.output), "the code");
  const paired = await robot.post("/api/v1/pair", { code, name: "owner" });
  assert.equal(paired.status, 200);
  const cookie = paired.headers.get("set-cookie").split(";")[0];
  const answer = await robot.post("/api/v1/tokens", { name: "test", role: "admin" }, { cookie, origin: robot.url });
  assert.equal(answer.status, 201);
  return { authorization: `Bearer ${(await answer.json()).token}` };
}

async function putPlace(robot, headers, name, x_m, y_m = 0) {
  const answer = await robot.fetch(`/api/v1/notes/places/${name}`,
    { method: "PUT", headers: { ...headers, "content-type": "application/json" }, body: JSON.stringify({ x_m, y_m }) });
  assert.equal(answer.status, 204);
}
const notesOf = async (robot, headers) => (await robot.fetch("/api/v1/notes", { headers })).json();

test(`whenever the power is cut, what was saved is there (${cuts} times)`, { timeout: 300000 }, async () => {
  const folder = newFolder(), notes = join(folder, "notes"), random = lots(9);
  const read = (name) => JSON.parse(readFileSync(join(notes, name), "utf8")).places;
  const older = () => readdirSync(notes).filter((name) => name.startsWith("notes-"));
  let robot = await run(folder);
  const headers = await own(robot);
  const known = new Map();
  for (let cut = 0; cut < cuts; ++cut) {
    let asked = 1, done = 1;
    const tokens = [];
    await putPlace(robot, headers, "p1", 1, cut);
    const writing = (async () => {
      for (;;) {
        ++asked;
        await putPlace(robot, headers, `p${asked % 40}`, asked, cut);
        done = asked;
        if (asked % 8) continue;
        const answer = await robot.post("/api/v1/tokens", { name: `t${cut}-${asked}`, role: "viewer" }, headers);
        if (answer.status === 201) tokens.push((await answer.json()).token);
      }
    })().catch((error) => { if (error instanceof assert.AssertionError) throw error; });
    await sleep(40 + 250 * random());
    await robot.stop("SIGKILL");
    await writing;
    const kept = read("notes.json"), newest = Math.max(...kept.map((place) => place.x_m));
    assert.ok(newest === done || newest === asked, `${newest} of ${done}, ${asked}`);
    for (const place of kept)
      assert.equal(place.x_m, newest - ((newest - Number(place.name.slice(1))) % 40 + 40) % 40, place.name);

    // Once more, while it starts, wherever it is by then.
    if (cut % 2) {
      const next = starting(folder);
      await sleep(150 * random());
      await next.stop("SIGKILL");
    }
    robot = await run(folder);
    const now = await notesOf(robot, headers);
    assert.deepEqual(now.places, [], "a new map");
    known.set(older().find((name) => isDeepStrictEqual(read(name), kept)) ?? assert.fail(older().join()), kept);
    for (const token of tokens) assert.equal((await robot.fetch("/api/v1/me", { headers: { authorization: `Bearer ${token}` } })).status, 200);
    const { people } = await (await robot.fetch("/api/v1/people", { headers })).json();
    for (const { id, name } of people) if (/^t\d/.test(name)) await robot.fetch(`/api/v1/people/${id}`, { method: "DELETE", headers });
    for (const name of older()) assert.deepEqual(read(name), known.get(name), name);
    assert.deepEqual([...readdirSync(folder), ...readdirSync(notes)].filter((name) => name.includes("damaged")), []);
  }
  assert.equal(older().length, Math.min(10, known.size));
  await robot.stop("SIGKILL");
});

test("whenever the power is cut, a recording can be read up to the last moment", { timeout: 300000 }, async () => {
  const folder = newFolder(), random = lots(17);
  const replay = async (file) => {
    const out = join(folder, "out");
    const { code, stderr } = await promisify(execFile)(binary, ["replay", file, "--out", out, "--quiet"])
      .then(({ stderr }) => ({ code: 0, stderr }), (error) => error);
    return { code, stderr, seconds: JSON.parse(readFileSync(join(out, "report.json"), "utf8")).duration_s };
  };
  for (let cut = 0; cut < Math.ceil(cuts / 5); ++cut) {
    const recordings = join(folder, String(cut));
    const robot = await recording(recordings);
    await until(async () => (await robot.json("/api/v1/recordings")).recording?.seconds > 1, "a recording");
    await sleep(1500 * random());
    const { recording: state } = await robot.json("/api/v1/recordings");
    await robot.stop("SIGKILL");
    const file = join(recordings, state.file);
    const whole = await replay(file);
    assert.equal(whole.code, 2, whole.stderr);
    assert.match(whole.stderr, /what came before is mapped/);
    assert.ok(whole.seconds > state.seconds - 1.5, `${whole.seconds} s of ${state.seconds} s`);

    // What a disk may do to the end of a file that was not on it yet.
    const size = statSync(file).size;
    for (const harm of [(path) => truncateSync(path, size - Math.floor(0.1 * size * random())),
      (path) => appendFileSync(path, Buffer.alloc(4096)), (path) => { truncateSync(path, size - 1000); truncateSync(path, size + 5000); }]) {
      copyFileSync(file, join(folder, "harmed.mcap"));
      harm(join(folder, "harmed.mcap"));
      const harmed = await replay(join(folder, "harmed.mcap"));
      assert.equal(harmed.code, 2, harmed.stderr);
      assert.match(harmed.stderr, /what came before is mapped/);
      assert.ok(harmed.seconds > 0.8 * whole.seconds - 1, `${harmed.seconds} s of ${whole.seconds} s`);
    }
    const next = await recording(recordings);
    await until(async () => (await next.json("/api/v1/recordings")).recording?.active, "the next recording");
    await next.stop();
    assert.equal(statSync(file).size, size, "the older one is left as it is");
  }
});

test("broken state is set aside, said in one line each, and the robot starts fresh", async () => {
  const folder = newFolder();
  mkdirSync(join(folder, "notes"));
  writeFileSync(join(folder, "access.json"), Buffer.alloc(512));
  mkdirSync(join(folder, "notes/notes.json"));
  mkdirSync(join(folder, "imu"));
  writeFileSync(join(folder, "imu/bno055-calibration"), "bno055 1 00");
  const robot = await run(folder);
  const headers = await own(robot);
  const { notice } = await notesOf(robot, headers);
  for (const name of ["access.json", "notes.json"]) assert.match(notice, new RegExp(`${name}.damaged`));
  const said = robot.output.split("\n").filter((line) => line.includes(".damaged"));
  assert.ok(said.length >= 1 && said.length <= 3, robot.output);
  assert.ok(existsSync(join(folder, "access.json.damaged")) && lstatSync(join(folder, "notes/notes.json.damaged")).isDirectory());
  const hasImu = execFileSync(binary, ["check-config", "/dev/null"], { encoding: "utf8" }).includes("[imu]");
  if (hasImu && said.length > 1) assert.equal(readFileSync(join(folder, "imu/bno055-calibration.damaged"), "utf8"), "bno055 1 00");
  await putPlace(robot, headers, "p", 1);
  assert.equal(await robot.stop(), 0);
  assert.equal(JSON.parse(readFileSync(join(folder, "notes/notes.json"))).places.length, 1);
});

test("where nothing can be saved the robot runs, says so, and keeps it until it ends", async () => {
  const robot = await run("/proc/nowhere");
  const headers = await own(robot);
  await putPlace(robot, headers, "p", 1);
  const notes = await notesOf(robot, headers);
  assert.equal(notes.places.length, 1);
  assert.match(notes.notice, /Nothing is saved until this is mended: cannot write to \/proc\/nowhere/);
  assert.match(robot.output, /Nothing is saved until this is mended/);
  assert.equal(await robot.stop(), 0);
});

/** When each file and folder was changed last, and how long it is. */
function looks(folder) {
  return [".", ...readdirSync(folder, { recursive: true })].sort().map((name) => {
    const { mtimeNs, ctimeNs, size } = lstatSync(join(folder, name), { bigint: true });
    return `${name} ${mtimeNs} ${ctimeNs} ${size}`;
  });
}

test("nothing is written while nobody asks for anything", { timeout: 60000 }, async () => {
  const folder = newFolder();
  const robot = await run(folder);
  await own(robot);
  await sleep(1000);
  const written = () => /^write_bytes: (\d+)$/m.exec(readFileSync(`/proc/${robot.process.pid}/io`, "utf8"))[1];
  const before = { files: looks(folder), bytes: written() };
  await sleep(20000);
  assert.deepEqual({ files: looks(folder), bytes: written() }, before);
  assert.equal(await robot.stop(), 0);
});

/** Whether there can be a machine without a network, and one that gets one. */
function canBeAlone() {
  try {
    execFileSync("unshare", ["--net", "ip", "link", "set", "lo", "up"], { stdio: "ignore" });
    return true;
  } catch {
    return false;
  }
}

test("without a network it serves, and says where it is once there is one", { skip: !canBeAlone() && "takes root and iproute2" }, async () => {
  const robot = launch("unshare", "--net", "sh", "-c", 'ip link set lo up; exec "$@"', "sh",
    binary, "run", "--set", "server.port=0", ...withState(newFolder()));
  await robot.serves();
  await until(() => /There is no network yet/.test(robot.output), "word of the network");
  const inside = (...command) => execFileSync("nsenter", ["--target", String(robot.process.pid), "--net", ...command], { encoding: "utf8" });
  const answer = JSON.parse(inside(process.execPath, "-e", `fetch("${robot.url}/healthz").then((a) => console.log(a.status))`));
  assert.equal(answer, 200);
  inside("ip", "address", "add", "192.168.77.7/24", "dev", "lo");
  await until(() => robot.output.includes(`http://192.168.77.7:${robot.port}/#pair=`), "the new address", 15000);
  assert.equal(await robot.stop(), 0);
});
