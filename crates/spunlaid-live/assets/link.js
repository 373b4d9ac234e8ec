// The connection with the program, messages as JSON and frames as bytes, and what both pages need.

const byId = (id) => document.getElementById(id);

/** A new element of the page with these properties. */
const element = (tag, properties = {}) => Object.assign(document.createElement(tag), properties);

class Link {
  /**
   * `hear` has a function for each kind of message (`settings`, `state`, `measured`, `applied`, …), `frame` for frames,
   * `open` and `closed` for the connection. `read` makes a frame of bytes.
   */
  constructor(hear, read) {
    Object.assign(this, { hear, read, stamp: 0 });
    this.connect();
    document.addEventListener("visibilitychange", () => this.look());
    // A page that wakes up does not wait for the next try.
    for (const woken of ["visibilitychange", "pageshow", "online"]) addEventListener(woken, () => this.wake());
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
      if (typeof data !== "string") return this.hear.frame(this.read(data));
      const message = JSON.parse(data);
      this.hear[message.is]?.(message);
    });
    this.socket.addEventListener("close", () => {
      this.hear.closed();
      this.retry = setTimeout(() => this.connect(), 1500);
    });
  }

  wake() {
    if (document.visibilityState !== "visible" || this.socket.readyState !== WebSocket.CLOSED) return;
    clearTimeout(this.retry);
    this.connect();
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

/** Whether nobody answers at this address because the program was started again, and has another one. */
const hasMoved = () => fetch(location.href, { method: "HEAD" }).then(({ status }) => status === 403, () => false);

/** Lets a button copy the text of a place; where that is not allowed, the text is marked. */
function copies(button, place) {
  const { textContent } = button;
  button.addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(place.textContent);
      button.textContent = "Copied";
    } catch {
      getSelection().selectAllChildren(place);
      button.textContent = "Selected: press Ctrl+C";
    }
    setTimeout(() => (button.textContent = textContent), 2500);
  });
}
