// SPDX-License-Identifier: MIT
// Pairs this browser, shows the state and the map, and stops the robot.
"use strict";

const $ = (id) => document.getElementById(id);
const say = (text) => { $("message").textContent = text; };

async function post(path, done) {
  try {
    const answer = await fetch(path, { method: "POST" });
    say(answer.ok ? done : (await answer.json()).error);
  } catch {
    say("the robot does not answer");
  }
}
$("stop").addEventListener("click", () => post("api/v1/stop", "stopped"));
$("clear").addEventListener("click", () => post("api/v1/clear_stop", "cleared"));

function show(state) {
  const number = (value, unit, digits = 2) => `${value.toFixed(digits)} ${unit}`;
  const { pose, verdict, battery, applied } = state;
  const lines = {
    where: pose ? (pose.lost ? "lost" : `${number(pose.x_m, "m")}, ${number(pose.y_m, "m")}`) : "not known yet",
    motion: verdict ? `${verdict.motion}${verdict.reason ? ": " + verdict.reason : ""}` : "not ready yet",
    speed: applied ? number(applied.v_mps, "m/s") : "",
    battery: battery ? `${number(battery.voltage_v, "V", 1)}, ${battery.level}` : "",
    driver: state.driver ?? "nobody",
  };
  $("state").replaceChildren(...Object.entries(lines).flatMap(([name, value]) => {
    const term = document.createElement("dt"), text = document.createElement("dd");
    term.textContent = name;
    text.textContent = value;
    return [term, text];
  }));
}

function watch() {
  const socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/api/v1/ws/state`);
  socket.onmessage = (event) => {
    document.querySelector("main").hidden = false;
    show(JSON.parse(event.data));
  };
  socket.onclose = () => setTimeout(watch, 2000);
}

async function pair(code, name) {
  try {
    const answer = await fetch("api/v1/pair", {
      method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ code, name }),
    });
    $("pair").hidden = answer.ok;
    say(answer.ok ? "paired" : (await answer.json()).error);
  } catch {
    say("the robot does not answer");
  }
}
$("name").value = /iPhone|iPad|Android/.exec(navigator.userAgent)?.[0] ?? "Browser";
$("pair").addEventListener("submit", (event) => {
  event.preventDefault();
  pair($("code").value, $("name").value);
});
// The link of a QR code; what is behind the # was not sent anywhere, and works once.
const invitation = /^#pair=([\w-]+)$/.exec(location.hash);
if (invitation) {
  history.replaceState(null, "", location.pathname);
  $("code").value = invitation[1];
  pair(invitation[1], $("name").value);
}

async function refreshMap() {
  try {
    const answer = await fetch("api/v1/map.png");
    $("pair").hidden = answer.status !== 401;
    if (answer.ok) {
      const before = $("map").src;
      $("map").src = URL.createObjectURL(await answer.blob());
      URL.revokeObjectURL(before);
    } else {
      say((await answer.json()).error);
    }
  } catch {
    say("the robot does not answer");
  }
  setTimeout(refreshMap, 3000);
}

watch();
refreshMap();
