// The page: passes messages between its parts and the board. docs/live-page.md describes the messages.
import { startLink } from "./link.js";
import { showPicture } from "./monitor.js";
import { startConsole } from "./console.js";
import { startPanel } from "./panel.js";
import { startMotion } from "./motion.js";
import { startUpload } from "./upload.js";
import { startCurves } from "./curves.js";
import { startOrbit } from "./orbit.js";

const element = (id) => document.getElementById(id);
let holder = "nobody";
let sendData;

// Messages that make the last notice obsolete.
const CLEARING = ["command", "choose", "picture", "upload"];

function send(message) {
  if (CLEARING.includes(message.type)) notify("");
  sendData(JSON.stringify(message));
}

// Shows a notice in place of the last notice; an empty text clears it.
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
startOrbit(send);

const HOLDERS = { you: "You have control.", other: "Another page has control; this one only watches.", nobody: "No page has control." };

// Shows who has control. A page without control has disabled controls.
function setHolder(found) {
  if (found !== holder) panel.release();
  holder = found;
  const isMine = holder === "you";
  document.body.dataset.holder = holder;
  element("holder").textContent = HOLDERS[holder];
  element("control").textContent = isMine ? "Release control" : "Take control";
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

const LISTS = ["scenes", "meshes", "fields"];

function showLists({ commands, ...lists }) {
  console_.setCommands(commands);
  for (const list of LISTS) element(list).replaceChildren(...lists[list].map((name) => choice(list, name)));
}

// A button that shows a scene, a mesh or a field.
function choice(list, name) {
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = name;
  button.disabled = holder !== "you";
  button.addEventListener("click", () => send({ type: "choose", list, name }));
  return button;
}

// Shows why the soft core drew the picture or computed the triangles for the engine, and why most
// triangles are not drawn.
function showRemarks({ stats }) {
  const by = stats?.backend === "cpu" ? "Drawn" : "Set up";
  const fallback = stats?.fallback && `${by} by the soft core, which is slow: ${stats.fallback}.`;
  const hint = stats?.hint && `${stats.hint}.`;
  const text = [fallback, hint].filter(Boolean).join(" ");
  if (element("remarks").textContent !== text) element("remarks").textContent = text;
}

const HANDLERS = {
  board: showBoard,
  lists: showLists,
  console: ({ text }) => console_.show(text),
  motion: motion.show,
  help: console_.showHelp,
  completions: console_.showCompletions,
  progress: showProgress,
  sample(sample) {
    showSample(sample);
    showRemarks(sample);
  },
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
