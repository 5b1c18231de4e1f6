// The connection that shows what the robot does: ticks, poses, log lines and pictures. It connects again by itself.

const kRetryFirst_ms = 400;
const kRetryMost_ms = 3000;
/** So long without a message, and the connection is given up: a network that swallows everything closes nothing. */
const kSilent_ms = 5000;

/**
 * The address of a WebSocket of this page's server.
 * @param {string} path
 * @returns {string}
 */
export function socketAddress(path) {
  return `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}${path}`;
}

/**
 * Splits a picture message: length of the head, head, JPEG.
 * @param {ArrayBuffer} bytes
 * @returns {import("./messages.js").Picture}
 */
export function splitPicture(bytes) {
  const length = new DataView(bytes).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  return { head, jpeg: new Blob([new Uint8Array(bytes, 4 + length)], { type: "image/jpeg" }), received_ms: performance.now() };
}

export class LiveConnection {
  /** @type {WebSocket | null} */
  #socket = null;
  #retry_ms = kRetryFirst_ms;
  #wantsPictures = false;

  /** @param {import("./bus.js").Bus} bus gets tick, pose, event, picture, and live: true or false */
  constructor(bus) {
    this.bus = bus;
    /** When something came last, of performance.now(). */
    this.news_ms = performance.now();
    setInterval(() => {
      if (this.#socket?.readyState === WebSocket.OPEN && performance.now() - this.news_ms > kSilent_ms) this.#socket.close();
    }, 1000);
    this.#connect();
  }

  /**
   * Asks for pictures, or for none while nobody sees them.
   * @param {boolean} wanted
   */
  wantPictures(wanted) {
    if (wanted === this.#wantsPictures) return;
    this.#wantsPictures = wanted;
    this.#send({ type: "want", picture: wanted });
  }

  /**
   * Asks for the next picture: the one with this number is on the screen.
   * @param {number} frame
   */
  pictureShown(frame) {
    this.#send({ type: "picture_shown", frame });
  }

  /** @param {object} message */
  #send(message) {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(message));
  }

  #connect() {
    const socket = new WebSocket(socketAddress("/live"));
    socket.binaryType = "arraybuffer";
    this.#socket = socket;
    socket.onopen = () => {
      this.#retry_ms = kRetryFirst_ms;
      this.news_ms = performance.now();
      this.#send({ type: "want", picture: this.#wantsPictures });
      this.bus.emit("live", true);
    };
    socket.onmessage = (message) => {
      this.news_ms = performance.now();
      if (typeof message.data !== "string") {
        this.bus.emit("picture", splitPicture(message.data));
        return;
      }
      const value = JSON.parse(message.data);
      this.bus.emit(value.type, value);
    };
    socket.onclose = () => {
      this.bus.emit("live", false);
      setTimeout(() => this.#connect(), this.#retry_ms);
      this.#retry_ms = Math.min(kRetryMost_ms, this.#retry_ms * 1.6);
    };
  }
}
