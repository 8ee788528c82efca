// The console: output, an input line with history, and completion with the lists of the firmware.
const MAX_LOG = 64 << 10;
const PROMPT = /^(\s*glint> )+/;
// Control sequences of terminals, and all control characters except the line feed.
const CONTROL = /\x1b\[[0-?]*[ -/]*[@-~]|[\x00-\x09\x0b-\x1f\x7f]/g;

// The longest common prefix of all words.
function common(words) {
  let start = words[0] ?? "";
  for (const word of words) while (!word.startsWith(start)) start = start.slice(0, -1);
  return start;
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
  // The words that complete a line, whether a press of Tab waits for them, and whether the last
  // press found none.
  let found = { line: "", words: [] };
  let [waits, isVain] = [false, false];
  // Whether the hint lists completions.
  let isListed = false;

  function show(text) {
    raw = (raw + text).slice(-MAX_LOG);
    const isAtEnd = log.scrollHeight - log.scrollTop - log.clientHeight < 40;
    // A prompt is not shown until a command follows it.
    const lines = raw.replace(CONTROL, "").split("\n");
    log.textContent = lines.map((line) => line.replace(PROMPT, "glint> ")).join("\n").replace(/glint> $/, "");
    if (isAtEnd) log.scrollTop = log.scrollHeight;
  }

  function clear() {
    raw = "";
    log.textContent = "";
  }

  function run(typed) {
    // Replaces tabs and unpaired surrogates. The browser's limit on the length of the input may cut a
    // surrogate pair.
    const line = typed.replace(/[\t\p{Surrogate}]/gu, " ");
    // An empty line is sent, too: it restarts a program that has ended.
    if (line.trim() !== "" && history.at(-1) !== line) history.push(line);
    place = history.length;
    send({ type: "command", line });
  }

  // Whether `found` has the words for the current line.
  const isKnown = () => found.line === input.value;
  const last = () => input.value.split(" ").at(-1);

  // Requests the words that complete the current line.
  function ask() {
    if (!isKnown()) send({ type: "complete", line: input.value });
  }

  function showHint() {
    if (isListed) return;
    const name = input.value.trimStart().split(" ")[0];
    const command = commands.find((command) => command.name === name);
    if (!command) {
      hint.textContent = input.value.trim() && isKnown() ? found.words.join("  ") : "";
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

  // Shows the words for the line, and completes the line if a press of Tab has waited for them.
  function showCompletions({ line, words }) {
    if (line !== input.value || isKnown()) return;
    found = { line, words };
    if (waits) complete();
    else showHint();
  }

  // Completes the word at the end of the line, or lists the words.
  function complete() {
    waits = false;
    const { words } = found;
    isVain = words.length === 0;
    if (isVain) return list("No completion; press Tab again to leave the line.");
    const start = last();
    // A number follows a word that ends in a colon, so no space is added.
    const end = words.length > 1 || words[0].endsWith(":") ? common(words) : `${words[0]} `;
    const isNew = end !== start;
    input.value = input.value.slice(0, input.value.length - start.length) + end;
    isListed = false;
    ask();
    showHint();
    if (!isNew) list(words.join("  "));
  }

  function list(text) {
    isListed = true;
    hint.textContent = text;
  }

  // Tab completes the line. It moves the focus on if the line is empty, if the press before it
  // found no completion, and after Escape.
  let leaves = false;
  input.addEventListener("keydown", (event) => {
    if (event.key === "Tab" && !event.shiftKey && !leaves && !isVain && input.value.trim() !== "") {
      event.preventDefault();
      waits = true;
      if (isKnown()) complete();
      else ask();
    }
    leaves = event.key === "Escape";
    if (event.key === "c" && event.ctrlKey && input.selectionStart === input.selectionEnd) send({ type: "interrupt" });
    const step = { ArrowUp: -1, ArrowDown: 1 }[event.key];
    if (step) {
      event.preventDefault();
      place = Math.min(Math.max(place + step, 0), history.length);
      input.value = history[place] ?? "";
      change();
    }
  });
  function change() {
    [isVain, isListed, waits] = [false, false, false];
    ask();
    showHint();
  }
  input.addEventListener("input", change);
  document.getElementById("interrupt").addEventListener("click", () => send({ type: "interrupt" }));
  document.getElementById("command").addEventListener("submit", (event) => {
    event.preventDefault();
    run(input.value);
    input.value = "";
    change();
  });

  function setCommands(list) {
    commands = list;
    asked = new Set(helps.keys());
    // The firmware's names may have changed.
    found = { line: null, words: [] };
  }

  return { show, clear, showHelp, showCompletions, setCommands };
}
