// The page: passes messages between its parts and the board. docs/live-page.md describes the messages.
import { startLink } from "./link.js";
import { showPicture } from "./monitor.js";
import { startConsole } from "./console.js";
import { startPanel } from "./panel.js";
import { startMotion } from "./motion.js";
import { startUpload } from "./upload.js";
import { startCurves } from "./curves.js";

const element = (id) => document.getElementById(id);
let holder = "nobody";
let sendData;

// Messages after which the last notice is out of date.
const CLEARING = ["command", "picture", "upload"];

function send(message) {
  if (CLEARING.includes(message.type)) notify("");
  sendData(JSON.stringify(message));
}

// Shows a notice, in place of the last one; an empty text shows none.
function notify(text, isError = true) {
  const notice = element("notice");
  notice.role = isError ? "alert" : "status";
  notice.textContent = text;
  notice.hidden = text === "";
}

const console_ = startConsole(send);
const panel = startPanel(send);
const showProgress = startUpload(send, (bytes) => sendData(bytes), notify);
const showSample = startCurves();
const motion = startMotion(send, notify);

const HOLDERS = { you: "You have control.", other: "Another page has control; this one only watches.", nobody: "No page has control." };

// Shows who has control. Without it the controls are disabled.
function setHolder(found) {
  if (found !== holder) panel.release();
  holder = found;
  const isMine = holder === "you";
  document.body.dataset.holder = holder;
  element("holder").textContent = HOLDERS[holder];
  element("control").textContent = isMine ? "Give up control" : "Take control";
  element("control").disabled = holder === "other";
  for (const control of document.querySelectorAll("main :is(input, button)")) control.disabled = !isMine;
}

element("control").addEventListener("click", () => send({ type: holder === "you" ? "release" : "take" }));

element("fetch").addEventListener("click", () => send({ type: "picture" }));

function showBoard({ name, has_pins, is_shared }) {
  element("board").textContent = `board ${name}`;
  document.body.classList.toggle("no-pins", !has_pins);
  document.body.classList.toggle("alone", !is_shared);
}

function showLists({ commands, scenes, fields }) {
  console_.setCommands(commands);
  element("scenes").replaceChildren(...scenes.map((name) => choice(name, `scene ${name}`)));
  const usual = fields.map((form) => PARAMETERS[form] ?? form.replace("DEPTH", PARAMETERS.DEPTH)).filter((form) => !/[A-Z]/.test(form));
  element("fields").replaceChildren(...usual.map((field) => choice(field.split(":")[0], `field ${field}`)));
}

// A button that sends a command.
function choice(text, command) {
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = text;
  button.disabled = holder !== "you";
  button.addEventListener("click", () => console_.run(command));
  return button;
}

// Values for the parameters of a field, by their names in the firmware's help.
const PARAMETERS = {
  "DEPTH": "3", "box:X,Y,Z": "box:0.5,0.3,0.2", "cubes:PERIOD,HALF": "cubes:1,0.2", "planes:HALF": "planes:0.8", "octahedron:S": "octahedron:0.6",
  "spheres:X,Y,Z,R;...": "spheres:0,0,0,0.4;0.5,0,0,0.2", "lattice:PERIOD,R": "lattice:1,0.25", "sphere:R": "sphere:0.5",
  "moving:R,ORBIT[,DEGREES]": "moving:0.3,0.4", "union:A+B": "union:sphere:0.4+box:0.6,0.2,0.2", "smooth:K,A+B": "smooth:0.2,sphere:0.4+box:0.6,0.2,0.2",
};

const HANDLERS = {
  board: showBoard,
  lists: showLists,
  console: ({ text }) => console_.show(text),
  motion: motion.show,
  help: console_.showHelp,
  progress: showProgress,
  sample: showSample,
  pins: panel.show,
  control: ({ holder }) => setHolder(holder),
  notice: ({ text, is_error }) => notify(text, is_error),
};

setHolder("nobody");
sendData = startLink({
  opened() {
    notify("");
    console_.clear();
  },
  received(data) {
    if (typeof data !== "string") return showPicture(data);
    const message = JSON.parse(data);
    HANDLERS[message.type]?.(message);
  },
  closed(text) {
    setHolder("nobody");
    notify(text);
  },
});
