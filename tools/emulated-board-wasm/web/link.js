// The link to the board: a worker of this page, in which the board runs, or which talks to a board on a serial port.
import { startSerial } from "./serial.js";

// The message to the worker after the page has taken the worker's last messages.
export const IS_TAKEN = null;

// Calls `opened` at the start of a board, `received` with each message, `closed` with a text for the user, and `notify` with an error that
// leaves the board as it is. Returns a function that sends a message: a text, or bytes.
export function startLink(page) {
  let board = startBoard(page, {});
  const releasePort = startSerial({
    connected(line, name) {
      board.end();
      const closed = (text) => {
        releasePort();
        page.closed(text);
      };
      board = startBoard({ ...page, closed }, { line, name });
    },
    disconnected() {
      board.end();
      board = startBoard(page, {});
    },
    lost(text) {
      board.end();
      page.closed(text);
    },
    notify: page.notify,
  });
  return (data) => board.send(data);
}

// Starts a worker. With a `line`, a channel of bytes, its board is on the serial port with this `name`.
function startBoard({ opened, received, closed }, { line, name }) {
  const worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
  let hasEnded = false;
  const end = () => {
    hasEnded = true;
    worker.terminate();
  };
  const stop = (reason) => {
    // The worker may fail after it has sent the reason for the end; only the first text is passed
    // on.
    if (hasEnded) return;
    end();
    if (line) closed(`The board's program on this page has stopped: ${reason}. Load the page again.`);
    else closed(`The board has stopped: ${reason}. Load the page again to start it.`);
  };
  worker.addEventListener("message", ({ data: { messages, end: reason } }) => {
    if (hasEnded) return;
    if (reason !== undefined) return stop(reason);
    messages.forEach(received);
    worker.postMessage(IS_TAKEN);
  });
  worker.addEventListener("error", (event) => stop(event.message ?? "the worker cannot be loaded"));
  worker.postMessage({ line, name }, line ? [line] : []);
  opened();
  return { send: (data) => worker.postMessage(data), end };
}
