// The board in a worker: loads its code, passes messages between it and the page, and runs it while it is behind the clock. The board is
// emulated, or is on a serial port.
import { IS_TAKEN } from "./link.js";
import { portFunctions } from "./port.js";

// The first message of the page. The listener is added before the first wait, so that it misses no message.
const started = new Promise((done) => addEventListener("message", ({ data }) => done(data), { once: true }));

// Kinds of messages that the board delivers, as in src/lib.rs.
const TEXT = 0;
const PICTURE = 1;
const END = 2;

let messages = [];
// Whether the page has taken the last messages. Until then, a newer picture replaces an older one.
let isTaken = true;

const memoryOf = () => new Uint8Array(board.memory.buffer);

function deliver(kind, start, length) {
  const bytes = memoryOf().subarray(start, start + length);
  if (kind === PICTURE) messages.push(bytes.slice().buffer);
  else if (kind === TEXT) messages.push(new TextDecoder().decode(bytes));
  else if (kind === END) end(new TextDecoder().decode(bytes));
}

function end(reason) {
  postMessage({ end: reason });
  close();
}

async function load(name) {
  const response = await fetch(new URL(name, import.meta.url));
  if (!response.ok) throw new Error(`${name}: expected a file, found status ${response.status}`);
  return response.arrayBuffer();
}

function put(bytes) {
  const start = board.inbox(bytes.length);
  memoryOf().set(bytes, start);
}

// Passes the board's messages to the page, if the page has taken the last ones.
function pass() {
  if (!isTaken) return;
  board.take();
  if (messages.length === 0) return;
  isTaken = false;
  postMessage({ messages }, messages.filter((message) => typeof message !== "string"));
  messages = [];
}

const now = () => performance.timeOrigin + performance.now();

// Starts an emulated board with its firmware.
async function startEmulated() {
  const [code, firmware] = await Promise.all(["board.wasm", "firmware.bin"].map(load));
  // The code has these functions for a board on a serial port only.
  const unused = { write_port() {}, read_port: () => 0 };
  const { instance } = await WebAssembly.instantiate(code, { env: { now, deliver, ...unused } });
  board = instance.exports;
  put(new Uint8Array(firmware));
  board.start();
  receiveEarly();
  return board.run;
}

// Starts the session with a board on a serial port. The session waits for the port's bytes; WebAssembly suspends it meanwhile.
async function startPort(line, name) {
  const { write_port, read_port } = portFunctions(line, memoryOf, pass);
  const suspending = { write_port: new WebAssembly.Suspending(write_port), read_port: new WebAssembly.Suspending(read_port) };
  const { instance } = await WebAssembly.instantiate(await load("board.wasm"), { env: { now, deliver, ...suspending } });
  board = instance.exports;
  put(new TextEncoder().encode(name));
  const connected = WebAssembly.promising(board.connect)();
  receiveEarly();
  await connected;
  return WebAssembly.promising(board.run);
}

// The exports of the board's code.
let board;
// The messages of the page from before the board's start; undefined after it.
let early = [];

function receive(data) {
  if (typeof data === "string") {
    put(new TextEncoder().encode(data));
    board.receive_text();
  } else {
    put(new Uint8Array(data));
    board.receive_bytes();
  }
}

function receiveEarly() {
  const messages = early;
  early = undefined;
  messages.forEach(receive);
}

const { line, name } = await started;

addEventListener("message", ({ data }) => {
  if (data === IS_TAKEN) isTaken = true;
  else if (early) early.push(data);
  else receive(data);
});

// The worker sends itself a message to start the next turn. Unlike a timer, the message has no
// minimum delay, and it is handled after the queued messages of the page.
const next = new MessageChannel();

try {
  const run = await (line ? startPort(line, name) : startEmulated());
  const turn = async () => {
    const aheadMs = await run();
    pass();
    if (aheadMs > 0) setTimeout(() => turn().catch(fail), aheadMs);
    else next.port2.postMessage(null);
  };
  next.port1.onmessage = () => turn().catch(fail);
  next.port2.postMessage(null);
} catch (error) {
  fail(error);
}

function fail({ message }) {
  end(message);
}
