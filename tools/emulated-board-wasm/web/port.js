// The serial port of a board, as two functions for the board's code in the worker. `line` passes bytes to and from the page, which has
// opened the port.

// The message of the page after the port has accepted the bytes of the worker's last message.
export const IS_WRITTEN = null;

// `memoryOf` returns the memory of the code, and `wait` is called before each wait for bytes. The code waits for the promises of both
// functions, so WebAssembly must suspend it.
export function portFunctions(line, memoryOf, wait) {
  let received = [];
  // Continue a read and a write.
  let [arrived, written] = [() => {}, () => {}];

  line.onmessage = ({ data }) => {
    if (data === IS_WRITTEN) return written();
    received.push(data);
    arrived();
  };

  async function write_port(start, length) {
    const accepted = new Promise((done) => (written = done));
    line.postMessage(memoryOf().slice(start, start + length));
    await accepted;
  }

  async function read_port(start, room, waitMs) {
    wait();
    if (received.length === 0) {
      await new Promise((done) => {
        const timer = setTimeout(done, waitMs);
        arrived = () => {
          clearTimeout(timer);
          done();
        };
      });
    }
    let length = 0;
    while (received.length > 0 && length < room) {
      const part = received[0].subarray(0, room - length);
      memoryOf().set(part, start + length);
      length += part.length;
      if (part.length < received[0].length) received[0] = received[0].subarray(part.length);
      else received.shift();
    }
    return length;
  }

  return { write_port, read_port };
}
