// The board in a worker: loads it, passes messages between it and the page, and runs it while it is behind the clock.
import { IS_TAKEN } from "./link.js";

// Kinds of messages that the board delivers, as in src/lib.rs.
const TEXT = 0;
const PICTURE = 1;
const END = 2;

let messages = [];
// Whether the page has taken the last messages. Until then, a newer picture replaces an older one.
let isTaken = true;

function deliver(kind, start, length) {
  const bytes = new Uint8Array(board.memory.buffer, start, length);
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
  new Uint8Array(board.memory.buffer, start, bytes.length).set(bytes);
}

const [code, firmware] = await Promise.all(["board.wasm", "firmware.bin"].map(load));
const { instance } = await WebAssembly.instantiate(code, { env: { now: () => performance.now(), deliver } });
const board = instance.exports;
put(new Uint8Array(firmware));
board.start();

addEventListener("message", ({ data }) => {
  if (data === IS_TAKEN) {
    isTaken = true;
  } else if (typeof data === "string") {
    put(new TextEncoder().encode(data));
    board.receive_text();
  } else {
    put(new Uint8Array(data));
    board.receive_bytes();
  }
});

// The worker sends itself a message to start the next turn. Unlike a timer, the message has no
// minimum delay, and it is handled after the queued messages of the page.
const next = new MessageChannel();
next.port1.onmessage = turn;

function turn() {
  const early = board.run();
  if (isTaken) {
    board.take();
    if (messages.length > 0) {
      isTaken = false;
      postMessage({ messages }, messages.filter((message) => typeof message !== "string"));
      messages = [];
    }
  }
  if (early > 0) setTimeout(turn, early);
  else next.port2.postMessage(null);
}

turn();
