// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { checkAnswer, contract, isSchema, operations, takesBody } from "./contract.mjs";
import { Robot, sleep, until } from "./robot.mjs";

let robot;
before(async () => {
  robot = await Robot.start();
  await until(async () => (await robot.json("/api/v1/state")).pose, "a pose");
});
after(() => robot.stop());

const ask = async (method, path, body, headers) =>
  checkAnswer(method, path, await robot.fetch(path, {
    method: method.toUpperCase(),
    headers: { ...(body === undefined ? {} : { "content-type": "application/json" }), ...headers },
    body: body === undefined ? undefined : JSON.stringify(body),
  }));

test("the first page is served soon after the start", () => {
  console.log(`start to address: ${robot.startMs.toFixed(0)} ms`);
  assert.ok(robot.startMs < 2000);
});

test("each operation without a body answers as the contract says", async () => {
  const plain = operations.filter(([method, path]) => method === "get" && !path.includes("{"));
  assert.ok(plain.length >= 10);
  for (const [method, path] of plain) assert.notEqual(await ask(method, path), "", path);
});

test("the contract itself is served", async () => {
  const text = await (await robot.fetch("/api/v1/openapi.yaml")).text();
  assert.ok(text.startsWith("openapi: 3.1"));
  assert.equal(contract.openapi, "3.1.0");
});

test("the map comes as picture, for ROS, and described", async () => {
  const png = await ask("get", "/api/v1/map.png");
  assert.deepEqual([...png.subarray(0, 4)], [0x89, 0x50, 0x4e, 0x47]);
  const pgm = await ask("get", "/api/v1/map.pgm");
  const [, width, height] = /^P5\s(\d+) (\d+)\s255\s/.exec(pgm.toString("latin1"));
  assert.ok(width > 50 && height > 50);
  assert.match((await ask("get", "/api/v1/map.yaml")).toString(), /^image: map.pgm\n(.*\n)*resolution: 0.02\n/);
});

const goals = [
  [{ x_m: 0.2, y_m: 0.1 }, 204],
  [{ x_m: 0.2, y_m: 0.1, yaw_rad: 1 }, 204],
  [{ x_m: 0.2, y_m: 0.1, name: "Küche" }, 204],
  [{ x_m: 0.2, y_m: 0.1, name: "a/b" }, 422],
  [{ x_m: 1000, y_m: 0 }, 422],
  [{ x_m: -1e308, y_m: 0 }, 422],
  [{ x_m: "1", y_m: 0 }, 422],
  [{ x_m: 1 }, 422],
  [{ x_m: null, y_m: 0 }, 422],
  [{ x_m: 1, y_m: 1, z_m: 1 }, 422],
  [{ x_m: 1, y_m: 1, yaw_rad: "north" }, 422],
];
test("goals are looked at closely", async () => {
  for (const [goal, status] of goals) {
    const answer = await robot.post("/api/v1/goal", goal);
    assert.equal(answer.status, status, JSON.stringify(goal));
    await checkAnswer("post", "/api/v1/goal", answer);
    if (!takesBody("post", "/api/v1/goal", goal)) assert.equal(status, 422);
  }
  assert.equal((await robot.post("/api/v1/mode", { mode: "manual" })).status, 204);
});

test("whatever the contract does not take for a body is refused, and the rest is not", async () => {
  const bodies = [{}, { mode: "manual" }, { mode: "explore" }, { mode: "navigate" }, { mode: "home" }, { mode: "fly" },
    { mode: 1 }, { mode: "patrol" }, { mode: "patrol", places: [] }, { mode: "patrol", places: "p" }, { mode: "home", places: ["p"] }, { mode: "manual" },
    { power_limit: 0.5 },
    { power_limit: 2 }, { power_limit: -1 }, { power_limit: "1" }, { power_limit: 0.5, more: 1 }];
  for (const path of ["/api/v1/mode", "/api/v1/power_limit"]) {
    for (const body of bodies) {
      const answer = await robot.post(path, body);
      assert.equal(answer.status === 422, !takesBody("post", path, body), `${path} ${JSON.stringify(body)} ${answer.status}`);
      await checkAnswer("post", path, answer);
    }
  }
  assert.equal((await robot.json("/api/v1/state")).power_limit, 0.5);
});

test("what people draw is kept by name; what the contract does not take is refused", async () => {
  const area = { corners: [[0, 0], [1, 0], [0.5, 1]] };
  const cases = [
    ["put", "places/{name}", "Küche 🤖", [{ x_m: 1, y_m: 2, yaw_rad: 0.5 }, { x_m: 1 }, { x_m: 1, y_m: 1001 }, { x_m: "1", y_m: 2 }, { x_m: 1, y_m: 2, z_m: 3 }]],
    ["put", "areas/{name}", "Stairs?#%", [area, { corners: [[0, 0], [1, 0]] }, { corners: [[0, 0], [1, 0], [1]] }, { corners: [[0, 0], [1, 0], [1, -1001]] },
      { corners: Array(65).fill([0, 0]) }, { corners: Array(64).fill([0, 0]) }, {}, area]],
    ["put", "home", "", [{ x_m: -1, y_m: 0 }, { x_m: -1, y_m: 0, name: "Dock" }, { x_m: -1, y_m: 0, name: "a\nb" }, { y_m: 0 }]],
  ];
  const before = (await robot.json("/api/v1/state")).notes_version;
  for (const [method, path, name, bodies] of cases) {
    for (const body of bodies) {
      const answer = await robot.fetch(`/api/v1/notes/${path.replace("{name}", encodeURIComponent(name))}`,
        { method: "PUT", headers: { "content-type": "application/json" }, body: JSON.stringify(body) });
      assert.equal(answer.status, takesBody(method, `/api/v1/notes/${path}`, body) ? 204 : 422, `${path} ${JSON.stringify(body).slice(0, 60)}`);
      await checkAnswer(method, `/api/v1/notes/${path}`, answer);
    }
  }
  const state = await robot.json("/api/v1/state");
  assert.ok(state.notes_version > before);
  const notes = await ask("get", "/api/v1/notes");
  assert.deepEqual(notes, { map_id: state.map_id, notice: "", home: { x_m: -1, y_m: 0, name: "Dock" },
    places: [{ name: "Küche 🤖", x_m: 1, y_m: 2, yaw_rad: 0.5 }], areas: [{ name: "Stairs?#%", ...area }] });
  const putPlace = (name, headers) => robot.fetch(`/api/v1/notes/places/${encodeURIComponent(name)}`,
    { method: "PUT", headers: { "content-type": "application/json", ...headers }, body: '{"x_m":0,"y_m":0}' });
  for (const name of ["x".repeat(41), "\n", ".hidden", " ", "a "]) {
    assert.equal((await putPlace(name)).status, 422, JSON.stringify(name));
    assert.ok(!isSchema("NoteName", name), JSON.stringify(name));
  }
  const taken = await putPlace("Küche 🤖", { "if-none-match": "*" });
  assert.equal(taken.status, 412, "nothing is replaced by what is to be new");
  await checkAnswer("put", "/api/v1/notes/places/{name}", taken);
  assert.equal((await robot.post("/api/v1/mode", { mode: "patrol", places: ["Küche 🤖"] })).status, 204);
  assert.equal((await robot.post("/api/v1/mode", { mode: "patrol", places: ["Attic"] })).status, 422);
  assert.equal((await robot.post("/api/v1/mode", { mode: "manual" })).status, 204);
  for (const path of [`places/${encodeURIComponent("Küche 🤖")}`, `areas/${encodeURIComponent("Stairs?#%")}`, "home", "notice"])
    assert.equal((await robot.fetch(`/api/v1/notes/${path}`, { method: "DELETE" })).status, 204, path);
  const after = await ask("get", "/api/v1/notes");
  assert.deepEqual({ ...after, map_id: "" }, { map_id: "", notice: "", home: null, places: [], areas: [] });
});

test("settings hold from when they are changed; what the contract does not take is refused", async () => {
  const path = "/api/v1/settings";
  const before = await ask("get", path);
  const bodies = [{}, { name: "Röt 🤖" }, { name: "" }, { name: "x".repeat(41) }, { name: "🤖".repeat(40) }, { name: 1 }, { trusted_range_m: 6 },
    { trusted_range_m: 0 }, { trusted_range_m: "6" }, { name: "new", more: 1 }];
  for (const body of bodies) {
    const answer = await robot.fetch(path, { method: "PATCH", headers: { "content-type": "application/json" }, body: JSON.stringify(body) });
    assert.equal(answer.status === 422, !takesBody("patch", path, body), `${JSON.stringify(body)} ${answer.status}`);
    await checkAnswer("patch", path, answer);
  }
  await ask("patch", path, { trusted_range_m: before.trusted_range_most_m + 1 });
  await ask("patch", path, { name: "a\nb" });
  assert.deepEqual(await ask("get", path), { ...before, name: "🤖".repeat(40), trusted_range_m: 6 });
  assert.deepEqual(await ask("patch", path, { name: before.name, trusted_range_m: before.trusted_range_m }), before);
});

test("bodies that are no JSON are refused in words", async () => {
  for (const [type, body, status] of [["application/json", "{", 400], ["application/json", '{"x_m":NaN}', 400],
    ["application/json", "[]", 400], ["text/plain", "{}", 415], ["application/json", "x".repeat(17000), 413]]) {
    const answer = await robot.fetch("/api/v1/goal", { method: "POST", headers: { "content-type": type }, body });
    assert.equal(answer.status, status, body.slice(0, 20));
    await checkAnswer("post", "/api/v1/goal", answer);
  }
});

test("the graph grows as the robot goes, and the state says how it stands", async () => {
  const tour = await Robot.start("--mission", "tour", "--speed", "4", "--seed", "3");
  const graph = await until(async () => {
    const answer = await tour.fetch("/api/v1/graph");
    const body = await checkAnswer("get", "/api/v1/graph", answer);
    return body.local_maps.length > 1 && body;
  }, "two local maps", 60000);
  for (const { x_m, y_m } of graph.local_maps) assert.ok(Math.hypot(x_m, y_m) < 50);
  const { pose, attitude, collision, verdict } = await tour.json("/api/v1/state");
  assert.ok(pose.covariance.xx_m2 > 0 && pose.covariance.xx_m2 < 1, JSON.stringify(pose));
  assert.ok(Math.abs(attitude.roll_rad) < 0.3 && Math.abs(attitude.pitch_rad) < 0.3);
  assert.equal(typeof collision, "boolean");
  assert.equal(verdict.cause === "none", verdict.motion === "go");
  await tour.stop();
});

test("STOP needs nothing, is latched, and can be cleared", async () => {
  const raw = await robot.rawAnswer(`POST /api/v1/stop HTTP/1.1\r\nHost: ${robot.host}\r\n\r\n`);
  assert.match(raw, /^HTTP\/1.1 204/);
  await until(async () => (await robot.json("/api/v1/state")).verdict.motion === "e-stop", "the stop");
  assert.equal((await robot.json("/api/v1/state")).verdict.cause, "stop");
  assert.equal(await ask("post", "/api/v1/clear_stop"), undefined);
  await until(async () => (await robot.json("/api/v1/state")).verdict.motion !== "e-stop", "the stop to be cleared");
});

test("what is not there is 404, and what cannot be done with it 405", async () => {
  for (const path of ["/api/v1/", "/api/v2/state", "/etc/passwd", "/api/v1/state/..", "/api/v1/ws/state"]) {
    const answer = await robot.fetch(path);
    assert.equal(answer.status, 404, path);
    assert.ok((await answer.json()).error);
  }
  for (const [, path] of operations.filter(([, p]) => !p.includes("{") && !contract.paths[p].put)) {
    const answer = await robot.fetch(path, { method: "PUT" });
    assert.equal(answer.status, 405, path);
    assert.ok(answer.headers.get("allow").length > 2);
  }
});

test("paths lead nowhere but where they say", async () => {
  for (const path of ["/../../../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd", "/page.js/../../etc/passwd",
    "/..%2f..%2fetc%2fpasswd", "/./page.jsx", "/CMakeLists.txt", "/web/openapi.yaml"]) {
    const raw = await robot.rawAnswer(`GET ${path} HTTP/1.1\r\nHost: ${robot.host}\r\n\r\n`);
    assert.match(raw, /^HTTP\/1.1 4\d\d/, path);
    assert.doesNotMatch(raw, /root:|cmake_minimum/, path);
  }
});

test("the page stands alone", async () => {
  const page = await robot.fetch("/");
  assert.match(page.headers.get("content-type"), /text\/html/);
  const text = await page.text();
  assert.doesNotMatch(text, /https?:\/\//);
  for (const [, file] of text.matchAll(/(?:src|href)="([^":]+)"/g)) assert.equal((await robot.fetch("/" + file)).status, 200, file);
});

test("a port that is taken ends the program with one line", async () => {
  await assert.rejects(Robot.start("--port", String(robot.port)), (error) => {
    assert.match(error.message, /^dynslam: .*port \d+ is taken; .*\n$/);
    return true;
  });
});

test("the program ends soon after it is asked to, whoever is there", async () => {
  const other = await Robot.start();
  const sockets = await Promise.all(["state", "video", "map", "control"].map((kind) => other.open(kind)));
  const idle = await other.raw();
  const began = Date.now();
  assert.equal(await other.stop("SIGINT"), 0);
  console.log(`asked to end until ended: ${Date.now() - began} ms`);
  assert.ok(Date.now() - began < 5000);
  await sleep(50);
  for (const socket of sockets) assert.equal(socket.closedWith.code, 1001);
  idle.destroy();
});
