// The button that connects the page to a board on a serial port.
import { IS_WRITTEN } from "./port.js";

// As `glint` opens a port. The BIOS, the firmware and the programs use this rate.
const BAUD = 115200;
// Bytes that the browser keeps while the page is busy: more than the board sends in five seconds.
const BUFFER = 64 << 10;

// Passes bytes between an open port and a line to the worker. Calls `failed` once if the port fails. Returns a function that ends this, and
// closes the port.
function pump(port, line, failed) {
  const writer = port.writable.getWriter();
  let reader;
  let isOver = false;

  const over = async () => {
    isOver = true;
    line.close();
    // A port that has failed cannot be cancelled or closed.
    await reader?.cancel().catch(() => {});
    await writer.abort().catch(() => {});
    writer.releaseLock();
    await port.close().catch(() => {});
  };
  const fail = ({ message }) => {
    if (isOver) return;
    over();
    failed(message);
  };

  async function read() {
    let error = new Error("Expected bytes of the board, found the end of the port's data.");
    // After a damaged byte or a full buffer, the port has a new stream; after it was unplugged, none.
    while (port.readable && !isOver) {
      reader = port.readable.getReader();
      try {
        for (;;) {
          const { value, done } = await reader.read();
          if (done) return fail(error);
          line.postMessage(value);
        }
      } catch (found) {
        error = found;
      } finally {
        reader.releaseLock();
      }
    }
    fail(error);
  }

  line.onmessage = ({ data }) => writer.write(data).then(() => line.postMessage(IS_WRITTEN), fail);
  read().catch(fail);
  return over;
}

// The USB device of a port, if it has one, to tell ports apart.
function nameOf(port) {
  const { usbVendorId, usbProductId } = port.getInfo();
  const text = (id) => id.toString(16).padStart(4, "0");
  return usbVendorId === undefined ? "on a serial port" : `on a serial port, USB ${text(usbVendorId)}:${text(usbProductId)}`;
}

// Calls `connected` with a line to an open port and its name, `disconnected` after the user has closed the port, `lost` with a text after
// the port has failed, and `notify` with an error after which everything is as before. Returns a function that closes the open port, if any.
export function startSerial({ connected, disconnected, lost, notify }) {
  const button = document.getElementById("connect");
  const canConnect = navigator.serial !== undefined && "Suspending" in WebAssembly;
  button.hidden = !canConnect;
  document.getElementById("no-serial").hidden = canConnect;
  if (!canConnect) return () => {};
  // Closes the open port, if any.
  let close;

  function set(found) {
    close = found;
    button.textContent = close ? "Disconnect" : "Connect a board";
  }

  async function connect() {
    // Without a choice of the user, nothing changes.
    const port = await navigator.serial.requestPort().catch(({ name, message }) => {
      if (name !== "NotFoundError") notify(`No serial port: ${message}`);
    });
    if (!port) return;
    try {
      await port.open({ baudRate: BAUD, bufferSize: BUFFER });
    } catch ({ message }) {
      return notify(`The serial port cannot be opened. Expected a port that this user may open, and that no other program or page has open; found: ${message}`);
    }
    const { port1, port2 } = new MessageChannel();
    try {
      set(pump(port, port1, (reason) => {
        set(undefined);
        lost(`The serial port has failed: ${reason} Check the cable and connect the board again, or load the page again for the emulated board.`);
      }));
    } catch (error) {
      await port.close().catch(() => {});
      throw error;
    }
    connected(port2, nameOf(port));
  }

  async function release() {
    const end = close;
    set(undefined);
    await end?.();
  }

  async function disconnect() {
    await release();
    disconnected();
  }

  // Runs an action. The button is disabled meanwhile.
  async function act(action) {
    button.disabled = true;
    try {
      await action();
    } catch ({ message }) {
      notify(`The serial port cannot be used: ${message}`);
    } finally {
      button.disabled = false;
    }
  }

  button.addEventListener("click", () => act(close ? disconnect : connect));
  return () => act(release);
}
