// The panel: LEDs, digits, switches and buttons.
const SVG = "http://www.w3.org/2000/svg";
// Outlines of the segments a to g, in a box of 60 by 100 units.
const SEGMENTS = [
  "M14 4H46L40 12H20Z", "M54 8V46L50 50L44 44V18Z", "M54 54V92L44 82V56L50 50Z", "M14 96H46L40 88H20Z",
  "M6 54V92L16 82V56L10 50Z", "M6 8V46L10 50L16 44V18Z", "M16 46H44L48 50L44 54H16L12 50Z",
];
// The direction of each button, and its function in the firmware, from docs/boards.md.
const BUTTONS = [
  ["up", "fire 1"],
  ["down", "fire 2"],
  ["left", "calibrate the sensor; together with BTN3 start the wireframe again"],
  ["right", "recentre the camera; together with BTN2 start the wireframe again"],
];
const VALUES = [0x3f, 0x06, 0x5b, 0x4f, 0x66, 0x6d, 0x7d, 0x07, 0x7f, 0x6f, 0x77, 0x7c, 0x39, 0x5e, 0x79, 0x71];

function shape(name, attributes) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

function digit() {
  const made = shape("svg", { viewBox: "0 0 72 100", "aria-hidden": "true" });
  made.append(...SEGMENTS.map((d) => shape("path", { d })), shape("circle", { cx: 65, cy: 91, r: 6 }));
  return made;
}

// The digits as text, with `-` for segments that do not form a hexadecimal digit.
function text(segments) {
  const character = (lit) => (lit & 0x7f ? (VALUES.indexOf(lit & 0x7f).toString(16).replace("-1", "-")) : " ");
  return segments.map((lit) => character(lit) + (lit & 0x80 ? "." : "")).join("");
}

export function startPanel(send) {
  const element = (id) => document.getElementById(id);
  const digits = Array.from({ length: 8 }, digit);
  const [left, right] = [document.createElement("div"), document.createElement("div")];
  left.append(...digits.slice(0, 4));
  right.append(...digits.slice(4));
  element("digits").append(left, right);
  const leds = Array.from({ length: 16 }, () => document.createElement("span"));
  element("leds").append(...leds.toReversed());

  const switches = Array.from({ length: 16 }, (_, number) => {
    const box = document.createElement("input");
    box.type = "checkbox";
    box.setAttribute("role", "switch");
    box.setAttribute("aria-label", `switch ${number}`);
    box.addEventListener("change", () => {
      const on = switches.reduce((all, box, bit) => all | (box.checked << bit), 0);
      send({ type: "switches", on });
    });
    return box;
  });
  for (const [number, box] of [...switches.entries()].toReversed()) {
    const label = document.createElement("label");
    label.append(box, String(number));
    element("switches").append(label);
  }

  let pressed = 0;
  const press = (number, isDown) => {
    const next = isDown ? pressed | (1 << number) : pressed & ~(1 << number);
    if (next !== pressed) send({ type: "buttons", pressed: (pressed = next) });
  };
  // With Shift a button stays pressed until its next press, so that one mouse can press two buttons together.
  let kept = 0;
  const begin = (number, { shiftKey, repeat }) => {
    if (repeat) return;
    const isKept = (kept >> number) & 1;
    kept = shiftKey && !isKept ? kept | (1 << number) : kept & ~(1 << number);
    press(number, true);
  };
  const end = (number) => (kept >> number) & 1 || press(number, false);
  const isKey = ({ key }) => key === " " || key === "Enter";
  const buttons = BUTTONS.map((_, number) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = `BTN${number}`;
    button.addEventListener("pointerdown", (event) => {
      button.setPointerCapture(event.pointerId);
      begin(number, event);
    });
    for (const name of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) button.addEventListener(name, () => end(number));
    button.addEventListener("keydown", (event) => isKey(event) && begin(number, event));
    button.addEventListener("keyup", (event) => isKey(event) && end(number));
    return button;
  });
  element("buttons").append(...buttons);

  // Describes the buttons; a program other than the firmware gives them functions of its own.
  function describe(isFirmware) {
    BUTTONS.forEach(([direction, purpose], number) => {
      buttons[number].title = isFirmware ? `${direction}: ${purpose}` : direction;
      buttons[number].setAttribute("aria-label", `button ${number}, ${buttons[number].title}`);
    });
  }
  describe(true);

  // In full screen the buttons lie over the picture, for fingers.
  addEventListener("fullscreenchange", () => {
    const parent = element(document.fullscreenElement ? "screen" : "panel");
    parent.insertBefore(element("buttons"), parent.querySelector("#motion"));
  });

  // A gamepad presses the buttons by its directions: up, down, left, right.
  const DIRECTIONS = [12, 13, 14, 15];
  const TILT = 0.5;
  let byGamepad = 0;
  let isReading = false;
  function readGamepads() {
    const pads = navigator.getGamepads().filter(Boolean);
    const isDown = (number) => pads.some(({ buttons, axes: [x = 0, y = 0] }) =>
      buttons[DIRECTIONS[number]]?.pressed || [-y, y, -x, x][number] > TILT);
    const now = BUTTONS.reduce((all, _, number) => all | (isDown(number) << number), 0);
    const changed = now ^ byGamepad;
    byGamepad = now;
    for (const number of BUTTONS.keys()) if ((changed >> number) & 1) press(number, Boolean((now >> number) & 1));
    isReading = pads.length > 0;
    if (isReading) requestAnimationFrame(readGamepads);
  }
  addEventListener("gamepadconnected", () => isReading || readGamepads());

  function show(pins) {
    leds.forEach((led, bit) => led.classList.toggle("lit", Boolean((pins.leds >> bit) & 1)));
    const lit = leds.flatMap((_, bit) => ((pins.leds >> bit) & 1 ? [bit] : []));
    element("leds").setAttribute("aria-label", lit.length ? `LEDs lit: ${lit.join(" ")}` : "LEDs: none lit");
    pins.digits.forEach((lit, number) => {
      [...digits[number].children].forEach((segment, bit) => segment.classList.toggle("lit", Boolean((lit >> bit) & 1)));
    });
    element("digits").setAttribute("aria-label", `Digits: ${text(pins.digits)}`);
    switches.forEach((box, bit) => (box.checked = Boolean((pins.switches >> bit) & 1)));
    buttons.forEach((button, bit) => button.setAttribute("aria-pressed", Boolean((pins.buttons >> bit) & 1)));
  }

  // Clears the pressed buttons; the board's side releases them when control passes to another page.
  const release = () => (pressed = kept = 0);

  return { show, release, describe };
}
