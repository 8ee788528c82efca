// Moves the camera by mouse, touch, wheel or keys on the picture.
const RADIANS_A_WIDTH = Math.PI;
const STEP = Math.PI / 36;
const ZOOM = 1.1;
const KEYS = { ArrowLeft: [-STEP, 0, 1], ArrowRight: [STEP, 0, 1], ArrowUp: [0, -STEP, 1], ArrowDown: [0, STEP, 1], "+": [0, 0, 1 / ZOOM], "-": [0, 0, ZOOM] };

export function startOrbit(send) {
  const picture = document.getElementById("monitor");
  const isMine = () => document.body.dataset.holder === "you";
  const move = (x, y, zoom) => send({ type: "orbit", turn: [x, y], zoom });
  // The position of each pressed pointer.
  const pressed = new Map();
  const spread = () => {
    const [[ax, ay], [bx, by]] = pressed.values();
    return Math.max(Math.hypot(ax - bx, ay - by), 1);
  };

  picture.addEventListener("pointerdown", (event) => {
    if (!isMine() || event.button !== 0) return;
    picture.setPointerCapture(event.pointerId);
    pressed.set(event.pointerId, [event.clientX, event.clientY]);
  });
  picture.addEventListener("pointermove", (event) => {
    const last = pressed.get(event.pointerId);
    if (!last || !isMine()) return;
    const next = [event.clientX, event.clientY];
    // One pointer turns the camera; two pointers zoom.
    const before = pressed.size === 2 && spread();
    pressed.set(event.pointerId, next);
    if (before) return move(0, 0, before / spread());
    const scale = RADIANS_A_WIDTH / picture.clientWidth;
    move((next[0] - last[0]) * scale, (next[1] - last[1]) * scale, 1);
  });
  for (const end of ["pointerup", "pointercancel"]) picture.addEventListener(end, ({ pointerId }) => pressed.delete(pointerId));
  picture.addEventListener(
    "wheel",
    (event) => {
      if (!isMine() || event.deltaY === 0) return;
      event.preventDefault();
      // A notch of a mouse wheel has about 100 units, a step of a touchpad fewer.
      move(0, 0, ZOOM ** Math.min(Math.max(event.deltaY / 100, -3), 3));
    },
    { passive: false },
  );
  picture.addEventListener("keydown", (event) => {
    if (!isMine() || event.ctrlKey || event.altKey || !(event.key in KEYS)) return;
    event.preventDefault();
    move(...KEYS[event.key]);
  });
}
