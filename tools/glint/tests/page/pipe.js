// A port of `navigator.serial` for the page's tests. At its other end is an emulated board in its BIOS, in WebAssembly.

// Longest time that the board runs without a pause, in milliseconds.
const SLICE_MS = 8;

async function load(name) {
  const response = await fetch(name);
  if (!response.ok) throw new Error(`${name}: status ${response.status}`);
  return response.arrayBuffer();
}

class Port {
  constructor(board) {
    this.board = board;
    // Whether another program has the port open.
    this.isTaken = false;
    // Number of bytes that the port still accepts.
    this.room = Infinity;
    this.hasRoom = () => {};
    // The streams of an open port.
    [this.readable, this.writable] = [null, null];
    this.last = performance.now();
    this.turn();
  }

  bytes(start, length) {
    return new Uint8Array(this.board.memory.buffer, start, length);
  }

  // Runs the board in real time. What it sends while the port is closed is lost.
  turn() {
    const now = performance.now();
    const length = this.board.run(Math.min(now - this.last, SLICE_MS));
    this.last = now;
    if (length > 0) this.received?.enqueue(this.bytes(this.board.output(), length).slice());
    setTimeout(() => this.turn());
  }

  getInfo() {
    return { usbVendorId: 0x0403, usbProductId: 0x6010 };
  }

  async open({ baudRate }) {
    if (this.isTaken) throw new DOMException("Failed to open serial port.", "NetworkError");
    if (baudRate !== 115200) throw new DOMException(`rate ${baudRate}`, "NotSupportedError");
    this.readable = new ReadableStream({ start: (received) => (this.received = received) });
    this.writable = new WritableStream({
      write: async (bytes) => {
        while (this.room <= 0) await new Promise((done) => (this.hasRoom = done));
        this.room -= bytes.length;
        this.bytes(this.board.buffer(bytes.length), bytes.length).set(bytes);
        this.board.send();
      },
    });
  }

  async close() {
    if (this.readable?.locked || this.writable?.locked) throw new TypeError("the streams are locked");
    this.received = undefined;
    [this.readable, this.writable] = [null, null];
  }

  // Sets the number of bytes that the port accepts from now on.
  accept(room) {
    this.room = room;
    this.hasRoom();
  }

  // Ends the connection as the loss of a USB cable does.
  unplug() {
    const { received } = this;
    this.received = undefined;
    [this.readable, this.writable] = [null, null];
    received.error(new DOMException("The device has been lost.", "NetworkError"));
  }
}

const [code, bios] = await Promise.all(["pipe.wasm", "bios.bin"].map(load));
const { instance } = await WebAssembly.instantiate(code, {});
const board = instance.exports;
const start = board.buffer(bios.byteLength);
new Uint8Array(board.memory.buffer, start).set(new Uint8Array(bios));
board.start();
export const port = new Port(board);

// Whether the user closes the browser's list of ports without a choice.
export const user = { hasChosen: true };

const requestPort = async () => {
  if (!user.hasChosen) throw new DOMException("No port selected by the user.", "NotFoundError");
  return port;
};
Object.defineProperty(navigator, "serial", { value: { requestPort } });
