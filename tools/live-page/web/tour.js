// The tour: short explanations of the parts of the page, one after another, some with a scene or a field on the board.
const STOPS = [
  { part: "#screen",
    text: "The board's monitor. Drag on the picture, or use the arrow keys, to move the camera; the wheel moves it " +
      "nearer or farther." },
  { part: "#scenes", show: ["scenes", "objects"],
    text: "A scene sets subject, camera and light at once. The scene objects has several meshes, each at its own place " +
      "and in its own colour." },
  { part: "#fields", show: ["scenes", "menger"],
    text: "A distance field is a solid given by a formula, as in the scene menger. A circuit of the chip finds its " +
      "surface for each pixel." },
  { part: "#programs", text: "Programs take the board for themselves: games and instruments. A button here returns to the firmware." },
  { part: "#model", text: "Your own model, with its textures, or your own program: choose it, or drop it anywhere on the page." },
  { part: "#command", text: "The board's console. Each click above types commands here; help lists them, and Tab completes them." },
  { part: "#motion",
    text: "Turn the motion sensor by dragging: the command imu look lets it steer the camera. A hand in front of the " +
      "camera turns the scene holoforge." },
  { part: "#curves", text: "The last minute: time of a frame, cycles of the engine, and the attitude of the sensor." },
];

// `show` shows an item of a list on the board, if the page has control and the list has the item.
export function startTour(show) {
  const element = (id) => document.getElementById(id);
  const dialog = element("tour");
  let stops = [];
  let current = 0;

  const mark = (part) => {
    document.querySelector(".toured")?.classList.remove("toured");
    part?.classList.add("toured");
  };

  function visit(number) {
    current = number;
    const { part, text, show: shown } = stops[number];
    const marked = document.querySelector(part);
    mark(marked);
    marked.scrollIntoView({ block: "nearest" });
    element("tour-text").textContent = text;
    element("tour-place").textContent = `${number + 1} of ${stops.length}`;
    element("tour-back").disabled = number === 0;
    element("tour-next").textContent = number + 1 === stops.length ? "End" : "Next";
    // A disabled button has no focus, and the keys of the dialog need one.
    if (number === 0) element("tour-next").focus();
    if (shown) show(...shown);
  }

  element("start-tour").addEventListener("click", () => {
    // Parts that this board or page does not have are left out.
    stops = STOPS.filter(({ part }) => document.querySelector(part).checkVisibility());
    dialog.show();
    visit(0);
  });
  element("tour-back").addEventListener("click", () => visit(current - 1));
  element("tour-next").addEventListener("click", () => (current + 1 < stops.length ? visit(current + 1) : dialog.close()));
  element("tour-end").addEventListener("click", () => dialog.close());
  dialog.addEventListener("keydown", ({ key }) => {
    if (key === "Escape") dialog.close();
  });
  dialog.addEventListener("close", () => {
    mark();
    element("start-tour").focus();
  });
}
