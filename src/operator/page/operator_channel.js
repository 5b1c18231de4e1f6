// The connection for requests: the protocol of docs/operator.md over a WebSocket, and the token.

import { socketAddress } from "./live_connection.js";

const kToken = "heel.token";
const kAnswer_ms = 5000;
const kRetry_ms = 1000;

/** The token of this tab; storage may be forbidden, and it then lasts until the page is loaded again. */
const tokens = {
  held: /** @type {string | null} */ (null),
  get() {
    try {
      return sessionStorage.getItem(kToken) ?? this.held;
    } catch {
      return this.held;
    }
  },
  /** @param {string | null} token */
  set(token) {
    this.held = token;
    try {
      if (token === null) sessionStorage.removeItem(kToken);
      else sessionStorage.setItem(kToken, token);
    } catch {
      // `held` has it.
    }
  },
};

export class OperatorChannel {
  /** @type {WebSocket | null} */
  #socket = null;
  #lastId = 0;
  /** @type {Map<number, {resolve: (answer: any) => void, timer: number}>} */
  #waiting = new Map();
  #mayWrite = false;

  /** @param {import("./bus.js").Bus} bus gets session, and status for each change that the daemon tells */
  constructor(bus) {
    this.bus = bus;
    this.#tellSession();
    this.#connect();
  }

  /**
   * Sends a request. It never throws: an answer that does not come is one with ok: false.
   * @param {Record<string, any>} request
   * @param {number} [wait_ms]
   * @returns {Promise<Record<string, any>>}
   */
  ask(request, wait_ms = kAnswer_ms) {
    const id = ++this.#lastId;
    return new Promise((resolve) => {
      if (this.#socket?.readyState !== WebSocket.OPEN) {
        resolve({ ok: false, error: "there is no connection to heeld" });
        return;
      }
      const timer = window.setTimeout(() => this.#settle({ id, ok: false, error: `no answer for ${wait_ms / 1000} s` }), wait_ms);
      this.#waiting.set(id, { resolve, timer });
      this.#socket.send(JSON.stringify({ v: 1, id, ...request }));
    });
  }

  /** Sends an emergency stop and waits for nothing. */
  tellEmergencyStop() {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify({ v: 1, do: "estop" }));
  }

  /**
   * @param {string} token
   * @returns {Promise<string>} empty, or why it was refused
   */
  async signIn(token) {
    const answer = await this.ask({ do: "login", token });
    this.#mayWrite = answer.ok && answer.may_write !== false;
    // A connection that ended has judged no token: it stays for the next one.
    if (this.#mayWrite) tokens.set(token);
    else if (this.#socket?.readyState === WebSocket.OPEN) tokens.set(null);
    this.#tellSession();
    return answer.ok ? "" : String(answer.error);
  }

  /** Forgets the token; the daemon knows a connection by its token, so this one ends. */
  signOut() {
    tokens.set(null);
    this.#mayWrite = false;
    this.#tellSession();
    this.#socket?.close();
  }

  #tellSession() {
    this.bus.emit("session", { mayWrite: this.#mayWrite, connected: this.#socket?.readyState === WebSocket.OPEN });
  }

  /** @param {any} answer */
  #settle(answer) {
    const waiting = this.#waiting.get(answer.id);
    if (!waiting) return;
    clearTimeout(waiting.timer);
    this.#waiting.delete(answer.id);
    if (answer.needs_token) {
      this.#mayWrite = false;
      this.#tellSession();
    }
    waiting.resolve(answer);
  }

  #connect() {
    const socket = new WebSocket(socketAddress("/operator"));
    this.#socket = socket;
    socket.onopen = () => {
      this.#tellSession();
      socket.send(JSON.stringify({ v: 1, do: "watch", period_s: 10 }));
      const token = tokens.get();
      if (token !== null) this.signIn(token);
    };
    socket.onmessage = (message) => {
      const answer = JSON.parse(message.data);
      if (answer.event === "status") this.bus.emit("status", answer);
      else this.#settle(answer);
    };
    socket.onclose = () => {
      this.#mayWrite = false;
      for (const id of [...this.#waiting.keys()]) this.#settle({ id, ok: false, error: "the connection to heeld has ended" });
      this.#tellSession();
      setTimeout(() => this.#connect(), kRetry_ms);
    };
  }
}
