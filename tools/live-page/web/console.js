// The console: output, a line with history, and completion by the lists of the firmware.
const MAX_LOG = 64 << 10;
const PROMPT = /^(\s*glint> )+/;
// Control sequences of terminals, and control characters but the line feed.
const CONTROL = /\x1b\[[0-?]*[ -/]*[@-~]|[\x00-\x09\x0b-\x1f\x7f]/g;

// The longest start that all words have.
function common(words) {
  let start = words[0] ?? "";
  for (const word of words) while (!word.startsWith(start)) start = start.slice(0, -1);
  return start;
}

// The fixed words for an argument in a line of help such as `ACTION: list or show or X,Y,Z`: those without capital letters.
function alternatives(line) {
  const words = line.slice(line.indexOf(":") + 1).split(" or ");
  return words.map((word) => word.trim().split(/[\[ ]/)[0]).filter((word) => word && !/[A-Z]/.test(word.split(":")[0]));
}

export function startConsole(send) {
  const log = document.getElementById("log");
  const input = document.getElementById("line");
  const hint = document.getElementById("hint");
  const history = [];
  const helps = new Map();
  let asked = new Set();
  let commands = [];
  let place = 0;
  let raw = "";

  function show(text) {
    raw = (raw + text).slice(-MAX_LOG);
    const isAtEnd = log.scrollHeight - log.scrollTop - log.clientHeight < 40;
    // A prompt is shown only before a command.
    const lines = raw.replace(CONTROL, "").split("\n");
    log.textContent = lines.map((line) => line.replace(PROMPT, "glint> ")).join("\n").replace(/glint> $/, "");
    if (isAtEnd) log.scrollTop = log.scrollHeight;
  }

  function clear() {
    raw = "";
    log.textContent = "";
  }

  function run(typed) {
    // Replaces tabs, and halves of characters that a length limit of the browser has cut.
    const line = typed.replace(/[\t\p{Surrogate}]/gu, " ");
    if (line.trim() === "") return;
    if (history.at(-1) !== line) history.push(line);
    place = history.length;
    send({ type: "command", line });
  }

  // The words that may follow in the line, and the start of the word at its end.
  function candidates() {
    const words = input.value.trimStart().split(/ +/);
    const start = words.at(-1);
    if (words.length === 1) return [start, commands.map(({ name }) => name)];
    const lines = helps.get(words[0]) ?? [];
    return [start, lines.slice(2).flatMap(alternatives)];
  }

  function showHint() {
    const name = input.value.trimStart().split(" ")[0];
    const command = commands.find((command) => command.name === name);
    if (!command) {
      const [start, words] = candidates();
      hint.textContent = start === "" ? "" : words.filter((word) => word.startsWith(start)).join("  ");
      return;
    }
    hint.textContent = helps.get(name)?.join("\n") ?? command.text;
    if (!asked.has(name) && input.value.includes(" ")) {
      asked.add(name);
      send({ type: "help", command: name });
    }
  }

  function showHelp({ command, lines }) {
    helps.set(command, lines);
    showHint();
  }

  // Completes the word at the end of the line. Returns whether there was something to complete.
  function complete() {
    const [start, words] = candidates();
    const found = words.filter((word) => word.startsWith(start));
    if (found.length === 0 || input.value.trim() === "") return false;
    const end = found.length === 1 ? `${found[0]} ` : common(found);
    const isNew = end !== start;
    input.value = input.value.slice(0, input.value.length - start.length) + end;
    showHint();
    if (!isNew) hint.textContent = found.join("  ");
    return true;
  }

  let leaves = false;
  input.addEventListener("keydown", (event) => {
    if (event.key === "Tab" && !event.shiftKey && !leaves && complete()) event.preventDefault();
    leaves = event.key === "Escape";
    if (event.key === "c" && event.ctrlKey && input.selectionStart === input.selectionEnd) send({ type: "interrupt" });
    const step = { ArrowUp: -1, ArrowDown: 1 }[event.key];
    if (step) {
      event.preventDefault();
      place = Math.min(Math.max(place + step, 0), history.length);
      input.value = history[place] ?? "";
      showHint();
    }
  });
  input.addEventListener("input", showHint);
  document.getElementById("interrupt").addEventListener("click", () => send({ type: "interrupt" }));
  document.getElementById("command").addEventListener("submit", (event) => {
    event.preventDefault();
    run(input.value);
    input.value = "";
    showHint();
  });

  function setCommands(list) {
    commands = list;
    asked = new Set(helps.keys());
  }

  return { show, clear, showHelp, setCommands };
}
