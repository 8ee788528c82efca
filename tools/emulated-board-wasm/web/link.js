// The link to the board: a worker of this page, in which the board runs.

// The message to the worker after the page has taken the worker's last messages.
export const IS_TAKEN = null;

// Calls `opened`, `received` with each message, and `closed` with a text for the user. Returns a function that sends a message: a text,
// or bytes.
export function startLink({ opened, received, closed }) {
  const worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
  let hasEnded = false;
  const end = (reason) => {
    // The worker may fail after it has sent the reason for the end; only the first text is passed
    // on.
    if (hasEnded) return;
    hasEnded = true;
    worker.terminate();
    closed(`The board has stopped: ${reason}. Load the page again to start it.`);
  };
  worker.addEventListener("message", ({ data: { messages, end: reason } }) => {
    if (reason !== undefined) return end(reason);
    messages.forEach(received);
    worker.postMessage(IS_TAKEN);
  });
  worker.addEventListener("error", (event) => end(event.message ?? "the worker cannot be loaded"));
  opened();
  return (data) => worker.postMessage(data);
}
