// SPDX-License-Identifier: MIT
// A way between browser and robot that can go dead or slow, as a network does, and nobody is told.
import { once } from "node:events";
import net from "node:net";

export class FlakyNetwork {
  static async to(robot) {
    const network = new FlakyNetwork();
    network.sockets = new Set();
    network.dead = false;
    network.late_ms = 0;
    network.server = net.createServer((near) => network.join(near, robot.port)).listen(0, "127.0.0.1");
    await once(network.server, "listening");
    network.url = `http://127.0.0.1:${network.server.address().port}`;
    return network;
  }

  join(near, port) {
    const far = net.connect(port, "127.0.0.1");
    for (const [from, to] of [[near, far], [far, near]]) {
      this.sockets.add(from);
      from.on("data", (bytes) => {
        if (this.dead) return;
        if (this.late_ms > 0) setTimeout(() => to.writable && to.write(bytes), this.late_ms);
        else to.write(bytes);
      });
      from.on("error", () => {});
      from.on("close", () => {
        this.sockets.delete(from);
        if (!this.dead) to.destroy();
      });
    }
  }

  die() {
    this.dead = true;
  }
  /** All comes through, but late. */
  slow(late_ms) {
    this.late_ms = late_ms;
  }
  /** Connections from before are gone; new ones come through. */
  live() {
    this.dead = false;
    for (const socket of this.sockets) socket.destroy();
  }
  async end() {
    this.live();
    this.server.close();
  }
}
