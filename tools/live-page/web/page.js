// The page: passes messages between its parts and the board. docs/live-page.md describes the messages.
import { startLink } from "./link.js";
import { clearPicture, showPicture } from "./monitor.js";
import { startConsole } from "./console.js";
import { startPanel } from "./panel.js";
import { startMotion } from "./motion.js";
import { startUpload } from "./upload.js";
import { startCurves } from "./curves.js";
import { startOrbit } from "./orbit.js";
import { startTour } from "./tour.js";

const element = (id) => document.getElementById(id);
let holder = "nobody";
let sendData;
// The parameters after `#` in the page's URL; empty after the page has processed them.
let address = new URLSearchParams(location.hash.slice(1));

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
const { show: showProgress, fetchFile, sendScene } = startUpload(send, (bytes) => sendData(bytes), notify, carry);
const showSample = startCurves();
const motion = startMotion(send, notify);
startOrbit(send);

const HOLDERS = { you: "You have control.", other: "Another page has control; this page only watches.", nobody: "No page has control." };

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
  followAddress();
}

element("control").addEventListener("click", () => send({ type: holder === "you" ? "release" : "take" }));

element("fetch").addEventListener("click", () => send({ type: "picture" }));

function showBoard({ name, has_pins, is_shared }) {
  element("board").textContent = `board ${name}`;
  document.body.classList.toggle("no-pins", !has_pins);
  document.body.classList.toggle("alone", !is_shared);
}

const LISTS = ["scenes", "meshes", "fields"];
const KEYS = { scenes: "scene", meshes: "mesh", fields: "field" };

let lists;

// Puts what the page shows into its URL, which is then a link to it; without a key removes it.
function carry(key, value) {
  history.replaceState(null, "", key ? `#${new URLSearchParams([[key, value]])}` : location.pathname + location.search);
}

function choose(list, name) {
  carry(KEYS[list], name);
  send({ type: "choose", list, name });
}

function showLists({ commands, ...shown }) {
  console_.setCommands(commands);
  panel.describe(commands.length > 0);
  lists = shown;
  for (const list of LISTS) {
    element(list).replaceChildren(...lists[list].map((name) => choice(name, () => choose(list, name))));
    for (const part of [element(list), element(`${list}-title`)]) part.hidden = lists[list].length === 0;
  }
  followAddress();
}

startTour((list, name) => {
  if (holder === "you" && lists?.[list].includes(name)) choose(list, name);
});

// A button that shows a scene, a mesh or a field, or starts a program.
function choice(name, choose) {
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = name;
  button.disabled = holder !== "you";
  button.addEventListener("click", choose);
  return button;
}

// Shows buttons for the programs in the page's folder, if any.
async function showPrograms() {
  const response = await fetch("programs.json").catch(() => undefined);
  const programs = response?.ok ? await response.json().catch(() => []) : [];
  for (const part of [element("programs"), element("programs-title")]) part.hidden = programs.length === 0;
  element("programs").replaceChildren(...programs.map(({ name, file }) => choice(name, () => fetchFile(file))));
}

// Shows the scene, mesh, field or program that the page's URL names, once: `#scene=NAME`, `#mesh=NAME`, `#field=NAME`,
// `#program=FILE` with a file in the page's folder, or `#scene=TEXT` with the text of a scene file.
function followAddress() {
  if (holder !== "you" || lists === undefined) return;
  for (const list of LISTS) {
    const name = address.get(KEYS[list]);
    if (name === null) continue;
    if (lists[list].includes(name)) choose(list, name);
    else if (list === "scenes" && name.includes("=")) sendScene(name);
    else notify(`#${location.hash.slice(1)}: expected one of ${lists[list].join(", ")}`);
  }
  const program = address.get("program");
  if (program !== null && /^[\w-]+(\.[\w-]+)*$/.test(program)) fetchFile(program);
  else if (program !== null) notify(`#program=${program}: expected the name of a file beside the page`);
  address = new URLSearchParams();
}

addEventListener("hashchange", () => {
  address = new URLSearchParams(location.hash.slice(1));
  followAddress();
});

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

element("full").addEventListener("click", () => element("screen").requestFullscreen().catch(({ message }) => notify(message)));
element("full").hidden = !document.fullscreenEnabled;

// Clears the state of the last board.
function forgetBoard() {
  setHolder("nobody");
  panel.release();
  showProgress({ done: 0, all: 0 });
  showRemarks({});
}

showPrograms();
setHolder("nobody");
sendData = startLink({
  opened() {
    forgetBoard();
    notify("");
    console_.clear();
    clearPicture();
  },
  received(data) {
    if (typeof data !== "string") return showPicture(data);
    const message = JSON.parse(data);
    HANDLERS[message.type]?.(message);
  },
  closed(text) {
    forgetBoard();
    notify(text);
  },
  notify,
});
