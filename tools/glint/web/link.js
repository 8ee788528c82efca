// The link to the board: a WebSocket to the program that serves the page.
const RETRY_MS = 1000;

// Calls `opened` when a connection is open, `received` with each message, and `closed` with a text
// for the user. Returns a function that sends a message, which is a text or bytes.
export function startLink({ opened, received, closed }) {
  let socket;
  let isOpen = false;

  function connect() {
    const address = new URL("socket", location.href);
    address.protocol = "ws:";
    socket = new WebSocket(address);
    socket.binaryType = "arraybuffer";
    socket.addEventListener("open", () => {
      isOpen = true;
      opened();
    });
    socket.addEventListener("message", ({ data }) => received(data));
    socket.addEventListener("close", ({ reason }) => {
      const wasOpen = isOpen;
      isOpen = false;
      closed(wasOpen
        ? `The server of this page has closed the connection${reason ? `: ${reason}` : ""}. Trying again.`
        : "The server of this page does not answer. If `glint board` was restarted, open the address that it prints. Trying again.");
      setTimeout(connect, RETRY_MS);
    });
  }

  connect();
  return (data) => {
    if (socket.readyState === WebSocket.OPEN) socket.send(data);
  };
}
