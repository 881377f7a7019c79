// SPDX-License-Identifier: MIT

export type SocketKind = "control" | "state" | "map" | "video";

export interface SocketEvents {
  opened?: () => void;
  text?: (message: unknown) => void;
  binary?: (message: ArrayBuffer) => void;
  /** `code` as in wire.md; 1006 when the network took it. */
  closed?: (code: number) => void;
}

const FIRST_WAIT_MS = 250;
const LONGEST_WAIT_MS = 4000;
/** A connection that neither opens nor fails, as when the robot is out of reach. */
const OPEN_WITHIN_MS = 5000;

/** A WebSocket of the robot that comes back by itself for as long as it is wanted. */
export class LiveSocket {
  private socket: WebSocket | null = null;
  private wanted = false;
  private wait_ms = FIRST_WAIT_MS;
  private timer = 0;

  constructor(
    readonly kind: SocketKind,
    private readonly events: SocketEvents,
  ) {}

  get isOpen(): boolean {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  start(): void {
    if (this.wanted) return;
    this.wanted = true;
    this.connect();
  }

  stop(): void {
    this.wanted = false;
    clearTimeout(this.timer);
    this.drop();
  }

  /** Does not wait any longer: the network may be back, or what is open may be dead. */
  reconnect(): void {
    if (!this.wanted) return;
    this.drop();
    this.wait_ms = FIRST_WAIT_MS;
    this.connect();
  }

  /** Lost when the socket is not open, or holds more than a phone should be behind. */
  send(message: string | ArrayBuffer): boolean {
    if (!this.socket || !this.isOpen || this.socket.bufferedAmount > 65536) return false;
    this.socket.send(message);
    return true;
  }

  private connect(): void {
    clearTimeout(this.timer);
    const url = new URL(`api/v1/ws/${this.kind}`, document.baseURI);
    url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(url);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    this.timer = window.setTimeout(() => socket.close(), OPEN_WITHIN_MS);
    socket.onopen = () => {
      clearTimeout(this.timer);
      this.wait_ms = FIRST_WAIT_MS;
      this.events.opened?.();
    };
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => this.take(event.data);
    socket.onclose = (event) => this.gone(socket, event.code);
  }

  private take(data: string | ArrayBuffer): void {
    if (typeof data === "string") this.events.text?.(JSON.parse(data));
    else this.events.binary?.(data);
  }

  private gone(socket: WebSocket, code: number): void {
    if (socket !== this.socket) return;
    this.socket = null;
    clearTimeout(this.timer);
    this.events.closed?.(code);
    if (!this.wanted) return;
    this.timer = window.setTimeout(() => this.connect(), this.wait_ms);
    this.wait_ms = Math.min(2 * this.wait_ms, LONGEST_WAIT_MS);
  }

  /** Forgets the connection; it is told of as closed at once, however long the network takes over it. */
  private drop(): void {
    const socket = this.socket;
    if (!socket) return;
    this.socket = null;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close();
    this.events.closed?.(1006);
  }
}
