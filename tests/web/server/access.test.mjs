// SPDX-License-Identifier: MIT
// Who may do what, seen from outside: each operation with each role, hosts, origins, cookies, and the wheel of one
// who is thrown out.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { checkAnswer, contract, operations } from "./contract.mjs";
import { Robot, sleep, until } from "./robot.mjs";

let robot, folder;
const tokens = {};
before(async () => {
  folder = mkdtempSync(join(tmpdir(), "recordings-"));
  robot = await Robot.start("--set", `recorder.folder=${folder}`);
  for (const role of ["viewer", "driver", "admin"]) {
    const answer = await robot.post("/api/v1/tokens", { name: `${role} of the test`, role });
    assert.equal(answer.status, 201);
    tokens[role] = await checkAnswer("post", "/api/v1/tokens", answer);
  }
});
after(async () => {
  await robot.stop();
  rmSync(folder, { recursive: true });
});

const bearer = (role) => ({ authorization: `Bearer ${role === "anyone" ? "x".repeat(43) : tokens[role].token}` });
const roles = ["anyone", "viewer", "driver", "admin"];
const bodies = {
  setGoal: { x_m: 0, y_m: 0 }, setMode: { mode: "manual" }, setPowerLimit: { power_limit: 1 }, pair: { code: "AAAA-AAAA", name: "x" },
  invite: { role: "viewer" }, makeToken: { name: "one more", role: "viewer" },
  changeSettings: {}, putPlace: { x_m: 0, y_m: 0 }, renamePlace: { name: "p" }, putArea: { corners: [[0, 0], [1, 0], [1, 1]] },
  putHome: { x_m: 0, y_m: 0 },
};

test("each operation is open to the role that the contract says, and to none below", async () => {
  for (const [method, path, operation] of operations) {
    if (operation.operationId === "logout") continue;  // it would take the token away
    for (const role of roles) {
      const at = path.replace(/\{\w+\}/, "nothing.mcap");
      const body = bodies[operation.operationId];
      const answer = await robot.fetch(at, {
        method: method.toUpperCase(),
        headers: { ...bearer(role), ...(body ? { "content-type": "application/json" } : {}) },
        body: body && JSON.stringify(body),
      });
      const allowed = roles.indexOf(role) >= roles.indexOf(operation["x-role"]);
      // A wrong code is a 401 too.
      if (operation.operationId !== "pair") assert.equal([401, 403].includes(answer.status), !allowed, `${role}: ${method} ${path} ${answer.status}`);
      await checkAnswer(method, path, answer);
    }
  }
  await robot.fetch("/api/v1/clear_stop", { method: "POST" });
});

test("WebSockets are for viewers; the wheel is for drivers", async () => {
  for (const kind of ["control", "state", "map", "video"]) {
    await assert.rejects(robot.open(kind, { headers: bearer("anyone") }));
    (await robot.open(kind, { headers: bearer("viewer") })).close();
  }
  const viewer = await robot.open("control", { headers: bearer("viewer") });
  viewer.send('{"lease":"take_over"}');
  await until(() => viewer.inbox.some((m) => m.error === "only a driver may take the wheel"), "the refusal");
  viewer.close();
});

test("foreign hosts and origins get nowhere; STOP needs no origin", async () => {
  const raw = (method, path, headers) => robot.rawAnswer(`${method} ${path} HTTP/1.1\r\n${headers}Content-Length: 0\r\n\r\n`);
  const host = `Host: ${robot.host}\r\n`;
  for (const path of ["/", "/healthz", "/api/v1/state"])
    assert.match(await raw("GET", path, "Host: evil.example\r\n"), /^HTTP\/1.1 403/, path);
  assert.match(await raw("GET", "/healthz", host), /^HTTP\/1.1 200/);
  assert.match(await raw("POST", "/api/v1/clear_stop", `${host}Origin: http://evil.example\r\n`), /^HTTP\/1.1 403/);
  assert.match(await raw("POST", "/api/v1/clear_stop", `${host}Origin: null\r\n`), /^HTTP\/1.1 403/);
  assert.match(await raw("POST", "/api/v1/clear_stop", `${host}Origin: ${robot.url}\r\n`), /^HTTP\/1.1 204/);
  assert.match(await raw("POST", "/api/v1/stop", host), /^HTTP\/1.1 204/);
  assert.match(await raw("POST", "/api/v1/stop", "Host: evil.example\r\n"), /^HTTP\/1.1 403/);
  for (const kind of ["control", "state", "map", "video"])
    await assert.rejects(robot.open(kind, { origin: "http://evil.example" }), kind);
  (await robot.open("state", { origin: robot.url })).close();
  assert.equal((await robot.post("/api/v1/clear_stop")).status, 204);
});

test("forged cookies and tokens are nobody's", async () => {
  for (const headers of [{ authorization: "Bearer " }, { authorization: "Bearer ../../x" }, { authorization: `Bearer ${"A".repeat(5000)}` }]) {
    const answer = await robot.fetch("/api/v1/state", { headers });
    assert.ok([200, 401].includes(answer.status));
    await checkAnswer("get", "/api/v1/state", answer);
  }
  assert.equal((await robot.fetch("/api/v1/state", { headers: bearer("anyone") })).status, 401);
});

test("an invitation pairs one browser, once; its cookie is for the robot alone", async () => {
  const { code, role } = await checkAnswer("post", "/api/v1/invitations", await robot.post("/api/v1/invitations", { role: "driver" }));
  assert.equal(role, "driver");
  let paired;  // wrong codes were tried from here before: that is slowed down, not forbidden
  await until(async () => (paired = await robot.post("/api/v1/pair", { code, name: "Ada's phone" })).status !== 429, "leave to pair", 60000);
  assert.equal(paired.status, 200);
  assert.match(paired.headers.get("set-cookie"), /^dynslam_session=[^;]+;.*HttpOnly.*SameSite=Strict/);
  assert.deepEqual(await checkAnswer("post", "/api/v1/pair", paired), { name: "Ada's phone", role: "driver" });
  const again = await robot.post("/api/v1/pair", { code, name: "Eve" });
  assert.notEqual(again.status, 200);
  await checkAnswer("post", "/api/v1/pair", again);
  const { people } = await robot.json("/api/v1/people");
  assert.ok(people.some((p) => p.name === "Ada's phone" && p.kind === "session" && p.role === "driver"));
  assert.ok(!JSON.stringify(people).includes(tokens.admin.token), "secrets are shown once");
});

test("who is thrown out loses his sockets and the wheel", async () => {
  const token = await (await robot.post("/api/v1/tokens", { name: "Mallory", role: "driver" })).json();
  const headers = { authorization: `Bearer ${token.token}` };
  const control = await robot.open("control", { headers }), state = await robot.open("state", { headers });
  control.send('{"lease":"acquire"}');
  await until(() => control.inbox.some((m) => m.wheel?.mine), "the wheel");
  assert.equal((await robot.json("/api/v1/state")).driver, "Mallory");
  assert.equal((await robot.fetch(`/api/v1/people/${token.id}`, { method: "DELETE" })).status, 204);
  await until(() => control.closedWith && state.closedWith, "both to close");
  assert.equal(control.closedWith.code, 1008);
  assert.equal((await robot.json("/api/v1/state")).driver, null);
  assert.equal((await robot.fetch("/api/v1/state", { headers })).status, 401);
  assert.equal((await robot.fetch(`/api/v1/people/${token.id}`, { method: "DELETE" })).status, 404);
});

test("a token logs itself out", async () => {
  const token = await (await robot.post("/api/v1/tokens", { name: "for a while", role: "viewer" })).json();
  const headers = { authorization: `Bearer ${token.token}` };
  assert.equal((await (await robot.fetch("/api/v1/me", { headers })).json()).role, "viewer");
  const out = await robot.fetch("/api/v1/logout", { method: "POST", headers });
  assert.equal(out.status, 204);
  assert.match(out.headers.get("set-cookie"), /Max-Age=0/);
  assert.equal((await robot.fetch("/api/v1/state", { headers })).status, 401);
});

test("a recording is begun, ended, fetched and deleted", async () => {
  const recording = async () => (await robot.json("/api/v1/state")).recording;
  assert.equal((await robot.post("/api/v1/recordings")).status, 204);
  await until(async () => (await recording())?.active, "the recording");
  assert.equal((await robot.post("/api/v1/recordings")).status, 409);
  await sleep(1500);
  const { file } = await recording();
  assert.equal((await robot.fetch(`/api/v1/recordings/${file}`, { method: "DELETE" })).status, 409);
  assert.equal((await robot.fetch("/api/v1/recordings", { method: "DELETE" })).status, 204);
  await until(async () => !(await recording()).active, "its end");
  const listed = await checkAnswer("get", "/api/v1/recordings", await robot.fetch("/api/v1/recordings"));
  const mine = listed.recordings.find((r) => r.name === file);
  const answer = await robot.fetch(`/api/v1/recordings/${file}`);
  assert.match(answer.headers.get("content-disposition"), /attachment/);
  const bytes = await checkAnswer("get", "/api/v1/recordings/{name}", answer);
  assert.equal(bytes.length, mine.bytes);
  assert.deepEqual([...bytes.subarray(0, 5)], [0x89, 0x4d, 0x43, 0x41, 0x50]);
  for (const name of ["..%2f..%2fetc%2fpasswd", ".hidden.mcap", "access.json", "nothing.mcap", "..", "%2e%2e%2fx.mcap"])
    assert.equal((await robot.fetch(`/api/v1/recordings/${name}`)).status, 404, name);
  assert.equal((await robot.fetch(`/api/v1/recordings/${file}`, { method: "DELETE" })).status, 204);
  assert.ok(!(await robot.json("/api/v1/recordings")).recordings.some((r) => r.name === file));
});

test("the contract gives each operation a role", () => {
  for (const [method, path, operation] of operations) assert.ok(roles.includes(operation["x-role"]), `${method} ${path}`);
  assert.ok(contract.components.securitySchemes.cookie.name);
});
