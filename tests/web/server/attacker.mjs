// SPDX-License-Identifier: MIT
// Everything that a bad client may do, over and over: node attacker.mjs PORT SECONDS [SEED]. Comes from other addresses
// of the loopback than those whom it must not disturb. Ends by itself, and says what it did.
import crypto from "node:crypto";
import net from "node:net";
import { WebSocket } from "ws";

const port = Number(process.argv[2]), seconds = Number(process.argv[3]);
let state = Number(process.argv[4] ?? 1) >>> 0;
const random = () => ((state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32);
const below = (n) => Math.floor(random() * n);
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const end = Date.now() + 1000 * seconds;
const done = {};
const count = (what) => { done[what] = (done[what] ?? 0) + 1; };
const address = () => `127.0.1.${1 + below(8)}`;
process.on("uncaughtException", (e) => { console.log(e); process.exit(1); });

function connect() {
  const socket = net.connect({ port, host: "127.0.0.1", localAddress: address() });
  socket.on("error", () => {});
  return socket;
}
function open(kind) {
  const socket = new WebSocket(`ws://127.0.0.1:${port}/api/v1/ws/${kind}`, { localAddress: address(), perMessageDeflate: false });
  socket.on("error", () => {});
  return socket;
}
const opened = (socket) => new Promise((resolve) => {
  socket.once("open", () => resolve(true));
  socket.once("close", () => resolve(false));
});
const kinds = ["control", "state", "map", "video"];
const have = Buffer.alloc(16);
have.writeUInt32LE(1);

/** A frame as it should not be. */
function frame({ first = 0x81, mask = true, length, payload = Buffer.alloc(0) }) {
  const head = [Buffer.from([first, (mask ? 0x80 : 0) | 127]), Buffer.alloc(8)];
  head[1].writeBigUInt64BE(BigInt(length ?? payload.length));
  return Buffer.concat([...head, mask ? Buffer.alloc(4) : Buffer.alloc(0), payload]);
}
const badFrames = [
  { first: 0x01, payload: Buffer.from("frag") }, { first: 0x80, payload: Buffer.from("ment") }, { first: 0xf1 },
  { first: 0x83 }, { mask: false, payload: Buffer.from("bare") }, { length: 2n ** 62n }, { length: 2n ** 31n, payload: Buffer.alloc(65536) },
  { first: 0x89, payload: Buffer.alloc(200) }, { first: 0x88, payload: Buffer.alloc(1) },
];

const attacks = {
  async idle() {
    const sockets = Array.from({ length: 50 }, connect);
    await sleep(below(3000));
    for (const socket of sockets) socket.destroy();
  },
  async halfOpen() {
    const socket = connect();
    socket.write("GET / HTTP/1.1\r\nHost: ");
    await sleep(below(2000));
    if (below(2)) socket.resetAndDestroy();
    else socket.destroy();
  },
  async slowLoris() {
    const socket = connect();
    socket.write("POST /api/v1/goal HTTP/1.1\r\nContent-Length: 1000\r\n");
    for (let i = 0; i < 20 && Date.now() < end; ++i) {
      socket.write(`X-${i}: a\r\n`);
      await sleep(300);
    }
    socket.destroy();
  },
  async slowBody() {
    const socket = connect();
    socket.write("POST /api/v1/power_limit HTTP/1.1\r\nContent-Type: application/json\r\nContent-Length: 1000\r\n\r\n");
    for (let i = 0; i < 20 && Date.now() < end; ++i) {
      socket.write(" ");
      await sleep(300);
    }
    socket.destroy();
  },
  async nonsense() {
    const socket = connect();
    socket.write(crypto.randomBytes(1 + below(40000)));
    await sleep(below(200));
    socket.destroy();
  },
  async hugeHead() {
    const socket = connect();
    socket.write("GET / HTTP/1.1\r\n" + "X: y\r\n".repeat(below(9000)) + "\r\n");
    await sleep(100);
    socket.destroy();
  },
  async stalls() {  // asks for much and takes nothing
    const socket = connect();
    socket.pause();
    socket.write(`GET /api/v1/ws/${kinds[1 + below(3)]} HTTP/1.1\r\nHost: 127.0.0.1:${port}\r\nUpgrade: websocket\r\n` +
      "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
    await sleep(200);
    socket.write(frame({ first: 0x82, payload: have }));
    await sleep(below(4000));
    if (below(2)) socket.resetAndDestroy();
    else socket.destroy();
  },
  async stallsHttp() {
    const socket = connect();
    socket.pause();
    socket.write(`GET /api/v1/map.pgm HTTP/1.1\r\nHost: 127.0.0.1:${port}\r\n\r\n`);
    await sleep(below(2000));
    socket.destroy();
  },
  async badFrames() {
    const socket = open(kinds[below(4)]);
    if (!(await opened(socket))) return;
    socket._socket.write(frame(badFrames[below(badFrames.length)]));
    await sleep(50);
    socket.terminate();
  },
  async hugeFrame() {
    const socket = open("control");
    if (!(await opened(socket))) return;
    socket.send(Buffer.alloc(1 + below(4 << 20)));
    await sleep(100);
    socket.terminate();
  },
  async flood() {
    const socket = open("control");
    if (!(await opened(socket))) return;
    for (let i = 0; i < 3000 && socket.readyState === WebSocket.OPEN; ++i) {
      socket.send(`{"seq":${below(100)},"v":${random() * 4 - 2},"w":1}`);
      if (i % 100 === 0) await sleep(1);
    }
    socket.terminate();
  },
  async babble() {
    const texts = ["", "{", "null", '{"seq":NaN}', '{"lease":"steal"}', "[".repeat(500), '{"seq":1,"v":1e999,"w":0}', "\u0000"];
    const socket = open("control");
    if (!(await opened(socket))) return;
    for (let i = 0; i < 20; ++i) socket.send(texts[below(texts.length)]);
    await sleep(50);
    socket.close();
    await sleep(50);
    socket.terminate();
  },
  async watch() {
    const socket = open(kinds[1 + below(3)]);
    socket.on("message", (data, binary) => {
      if (binary && data[0] === 3 && random() < 0.9) socket.send(`{"ack":${data.readUInt32LE(4)}}`);
    });
    if (!(await opened(socket))) return;
    if (socket.url.endsWith("map")) socket.send(have);
    await sleep(below(2000));
    if (below(2)) socket.terminate();
    else socket.close();
    await sleep(50);
    socket.terminate();
  },
  async askAround() {
    const paths = ["/", "/metrics", "/api/v1/state", "/api/v1/map.png", "/api/v1/devices", "/healthz", "/../etc/passwd", "/api/v1/nothing"];
    const socket = connect();
    socket.resume();
    socket.write(`GET ${paths[below(paths.length)]} HTTP/1.1\r\nHost: 127.0.0.1:${port}\r\n\r\n`);
    await sleep(30);
    socket.destroy();
  },
  async burst() {
    const sockets = Array.from({ length: 300 }, connect);
    await sleep(20);
    for (const socket of sockets) socket.destroy();
  },
};

const names = Object.keys(attacks);
await Promise.all(Array.from({ length: 12 }, async () => {
  while (Date.now() < end) {
    const name = names[below(names.length)];
    await attacks[name]();
    count(name);
    await sleep(below(50));
  }
}));
console.log(JSON.stringify(done));
process.exit(0);
