// The page: connects to the server, and passes messages between it and the parts. docs/live-page.md describes the messages.
import { showPicture } from "./monitor.js";
import { startConsole } from "./console.js";
import { startPanel } from "./panel.js";

const RETRY_MS = 1000;
const element = (id) => document.getElementById(id);
let socket;
let holder = "nobody";

function send(message) {
  if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
}

function notify(text) {
  element("notice").textContent = text;
  element("notice").hidden = text === "";
}

const console_ = startConsole(send);
const panel = startPanel(send);

const HOLDERS = { you: "You have control.", other: "Another page has control; this one shows.", nobody: "No page has control." };

// Shows who has control. Without it the controls are disabled.
function setHolder(found) {
  holder = found;
  const isMine = holder === "you";
  document.body.dataset.holder = holder;
  element("holder").textContent = HOLDERS[holder];
  element("control").textContent = isMine ? "Give up control" : "Take control";
  element("control").disabled = holder === "other";
  for (const control of document.querySelectorAll("main :is(input, button)")) control.disabled = !isMine;
}

element("control").addEventListener("click", () => send({ type: holder === "you" ? "release" : "take" }));

function showBoard({ name, has_pins }) {
  element("board").textContent = `board ${name}`;
  document.body.classList.toggle("no-pins", !has_pins);
}

function showLists({ commands, scenes }) {
  console_.setCommands(commands);
  const choose = (name) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = name;
    button.disabled = holder !== "you";
    button.addEventListener("click", () => console_.run(`scene ${name}`));
    return button;
  };
  element("scenes").replaceChildren(...scenes.map(choose));
}

const HANDLERS = {
  board: showBoard,
  lists: showLists,
  console: ({ text }) => console_.show(text),
  help: console_.showHelp,
  pins: panel.show,
  control: ({ holder }) => setHolder(holder),
  notice: ({ text }) => notify(text),
};

function connect() {
  const address = new URL("socket", location.href);
  address.protocol = "ws:";
  socket = new WebSocket(address);
  socket.binaryType = "arraybuffer";
  socket.addEventListener("open", () => {
    notify("");
    console_.clear();
  });
  socket.addEventListener("message", ({ data }) => {
    if (typeof data !== "string") return showPicture(data);
    const message = JSON.parse(data);
    HANDLERS[message.type]?.(message);
  });
  socket.addEventListener("close", ({ reason }) => {
    setHolder("nobody");
    notify(`The board's program has closed the connection${reason ? `: ${reason}` : ""}. Trying again.`);
    setTimeout(connect, RETRY_MS);
  });
}

setHolder("nobody");
connect();
