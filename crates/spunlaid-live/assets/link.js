// The connection with the program: messages as JSON, frames as bytes.

/** Reads a frame; src/live/frame.rs describes its bytes. */
function readFrame(buffer) {
  const view = new DataView(buffer);
  const bits = view.getUint8(4);
  const count = view.getUint8(5);
  const nodes = Array.from({ length: count }, (_, i) => view.getUint16(22 + 2 * i, true));
  const numbers = new Float32Array(buffer, 48);
  let at = 0;
  const take = (length) => numbers.subarray(at, (at += length));
  return {
    generation: view.getUint32(0, true),
    stands: Boolean(bits & 1),
    behind: Boolean(bits & 2),
    fed: Boolean(bits & 4),
    time: view.getFloat64(8, true),
    speed: view.getFloat32(16, true),
    firstSample: view.getUint32(40, true),
    firstPoint: view.getUint32(44, true),
    shapes: nodes.map((n) => take(3 * n)),
    samples: take(4 * view.getUint16(6, true)),
    points: take(2 * view.getUint16(20, true)),
  };
}

class Link {
  /**
   * `hear` has a function for each kind of message (`settings`, `state`, `measured`, `applied`, …), `frame` for frames,
   * `open` and `closed` for the connection.
   */
  constructor(hear) {
    this.hear = hear;
    this.stamp = 0;
    this.connect();
    document.addEventListener("visibilitychange", () => this.look());
  }

  connect() {
    const address = new URL("flight", location.href);
    address.protocol = "ws:";
    this.socket = new WebSocket(address);
    this.socket.binaryType = "arraybuffer";
    this.socket.addEventListener("open", () => {
      this.hear.open();
      this.look();
    });
    this.socket.addEventListener("message", ({ data }) => {
      if (typeof data !== "string") return this.hear.frame(readFrame(data));
      const message = JSON.parse(data);
      this.hear[message.is]?.(message);
    });
    this.socket.addEventListener("close", () => {
      this.hear.closed();
      setTimeout(() => this.connect(), 1500);
    });
  }

  look() {
    this.ask({ do: "look", visible: document.visibilityState === "visible" });
  }

  ask(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  /** Changes a key; returns the stamp that the answer will have. */
  set(key, value) {
    this.stamp += 1;
    this.ask({ do: "set", key, value, stamp: this.stamp });
    return this.stamp;
  }
}
