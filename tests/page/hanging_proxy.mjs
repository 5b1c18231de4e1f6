// A server between browser and heeld that can let everything hang but the emergency stop.

import { createServer, request } from "node:http";
import { connect } from "node:net";

export class HangingProxy {
  hangs = false;
  hanging = 0;
  #sockets = new Set();

  /** @param {number} port of heeld */
  async begin(port) {
    this.server = createServer((asked, answer) => {
      if (this.hangs && asked.url !== "/estop") {
        ++this.hanging;
        return;
      }
      const passed = request({ host: "127.0.0.1", port, path: asked.url, method: asked.method, headers: asked.headers }, (got) => {
        answer.writeHead(got.statusCode, got.headers);
        got.pipe(answer);
      });
      passed.on("error", () => answer.destroy());
      asked.pipe(passed);
    });
    this.server.on("connection", (socket) => this.#keep(socket));
    this.server.on("upgrade", (asked, socket) => this.#passOn(asked, socket, port));
    await new Promise((done) => this.server.listen(0, "127.0.0.1", done));
    this.address = `http://127.0.0.1:${this.server.address().port}`;
  }

  end() {
    for (const socket of this.#sockets) socket.destroy();
    this.server.close();
  }

  #keep(socket) {
    this.#sockets.add(socket);
    socket.on("error", () => {});
    socket.on("close", () => this.#sockets.delete(socket));
  }

  /** A WebSocket: bytes both ways, and none while it hangs. */
  #passOn(asked, socket, port) {
    const heeld = connect(port, "127.0.0.1", () => {
      const head = asked.rawHeaders.reduce((text, part, i) => text + part + (i % 2 ? "\r\n" : ": "), "");
      heeld.write(`${asked.method} ${asked.url} HTTP/1.1\r\n${head}\r\n`);
    });
    this.#keep(heeld);
    for (const [from, to] of [[socket, heeld], [heeld, socket]]) {
      from.on("data", (bytes) => this.hangs || to.write(bytes));
      from.on("close", () => to.destroy());
    }
  }
}
