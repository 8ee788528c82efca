// The motion sensor, which the mouse, keys or this device turn, and the hand in front of the
// camera.
const STEP = Math.PI / 36;
const PLATE = [[-1, -0.65, 0], [1, -0.65, 0], [1, 0.65, 0], [-1, 0.65, 0]];
const ARROW = [[0, -0.4, 0.02], [0, 0.45, 0.02], [-0.2, 0.2, 0.02], [0, 0.45, 0.02], [0.2, 0.2, 0.02]];

function product([aw, ax, ay, az], [bw, bx, by, bz]) {
  return [
    aw * bw - ax * bx - ay * by - az * bz, aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw,
  ];
}

function about(axis, angle) {
  const turn = [Math.cos(angle / 2), 0, 0, 0];
  turn[1 + axis] = Math.sin(angle / 2);
  return turn;
}

function rotated([w, x, y, z], point) {
  return product(product([w, x, y, z], [0, ...point]), [w, -x, -y, -z]).slice(1);
}

export function startMotion(send, notify) {
  const sensor = document.getElementById("sensor");
  const hand = document.getElementById("hand");
  const use = document.getElementById("device");
  let attitude = [1, 0, 0, 0];
  let place = null;

  function drawSensor() {
    const context = sensor.getContext("2d");
    const { width, height } = sensor;
    const style = getComputedStyle(sensor);
    // Projects a point as seen from the front and above.
    const seen = ([x, y, z]) => [width / 2 + 0.36 * width * x, height / 2 - 0.36 * width * (0.5 * y + 0.87 * z)];
    const path = (points) => {
      context.beginPath();
      for (const point of points) context.lineTo(...seen(rotated(attitude, point)));
    };
    context.clearRect(0, 0, width, height);
    path(PLATE);
    context.closePath();
    const isFromAbove = rotated(attitude, [0, 0, 1])[2] - 0.58 * rotated(attitude, [0, 0, 1])[1] > 0;
    context.fillStyle = isFromAbove ? "#1f7a4d" : "#6b5a2e";
    context.fill();
    context.strokeStyle = style.color;
    context.lineWidth = 2;
    context.stroke();
    path(ARROW);
    context.strokeStyle = "#ffffff";
    context.lineWidth = 3;
    context.stroke();
  }

  function turn(next) {
    const length = Math.hypot(...next);
    attitude = next.map((c) => c / length);
    drawSensor();
    send({ type: "turn", attitude });
  }

  const isMine = () => document.body.dataset.holder === "you";
  let last = null;
  sensor.addEventListener("pointerdown", (event) => {
    if (!isMine()) return;
    sensor.setPointerCapture(event.pointerId);
    last = [event.clientX, event.clientY];
  });
  sensor.addEventListener("pointermove", (event) => {
    if (!last) return;
    const [dx, dy] = [event.clientX - last[0], event.clientY - last[1]];
    last = [event.clientX, event.clientY];
    turn(product(product(about(2, dx / 80), about(0, dy / 80)), attitude));
  });
  for (const end of ["pointerup", "pointercancel"]) sensor.addEventListener(end, () => (last = null));
  const KEYS = { ArrowLeft: [2, -STEP], ArrowRight: [2, STEP], ArrowUp: [0, -STEP], ArrowDown: [0, STEP], PageUp: [1, -STEP], PageDown: [1, STEP] };
  sensor.addEventListener("keydown", (event) => {
    if (!isMine() || !(event.key in KEYS || event.key === "Home")) return;
    event.preventDefault();
    turn(event.key === "Home" ? [1, 0, 0, 0] : product(about(...KEYS[event.key]), attitude));
  });
  document.getElementById("level").addEventListener("click", () => turn([1, 0, 0, 0]));

  // The angles of a device are rotations about z, then x, then y.
  function follow({ alpha, beta, gamma }) {
    if (alpha === null) return;
    clearTimeout(patience);
    if (!isMine()) return;
    const [z, x, y] = [alpha, beta, gamma].map((angle) => (angle * Math.PI) / 180);
    turn(product(product(about(2, z), about(0, x)), about(1, y)));
  }
  // Browsers do not report why they send no events, so a time-out detects this.
  let patience;
  function fail() {
    use.checked = false;
    removeEventListener("deviceorientation", follow);
    notify("This device does not report its orientation. Expected a device with a sensor, a page of https or localhost, and permission.");
  }
  use.addEventListener("change", async () => {
    clearTimeout(patience);
    removeEventListener("deviceorientation", follow);
    if (!use.checked) return;
    const answer = await globalThis.DeviceOrientationEvent?.requestPermission?.().catch(() => "denied");
    if (answer !== undefined && answer !== "granted") return fail();
    patience = setTimeout(fail, 3000);
    addEventListener("deviceorientation", follow);
  });

  function drawHand() {
    const context = hand.getContext("2d");
    context.fillStyle = "#39424c";
    context.fillRect(0, 0, hand.width, hand.height);
    if (!place) return;
    context.fillStyle = "#d99a77";
    context.beginPath();
    context.arc(place[0] * hand.width, place[1] * hand.height, hand.width * 0.12, 0, 2 * Math.PI);
    context.fill();
  }

  function moveHand(next) {
    place = next?.map((c) => Math.min(Math.max(c, 0), 1)) ?? null;
    drawHand();
    send({ type: "hand", place });
  }

  const show = (event) => {
    const box = hand.getBoundingClientRect();
    moveHand([(event.clientX - box.x) / box.width, (event.clientY - box.y) / box.height]);
  };
  hand.addEventListener("pointerdown", (event) => {
    if (!isMine()) return;
    hand.setPointerCapture(event.pointerId);
    show(event);
  });
  hand.addEventListener("pointermove", (event) => isMine() && event.buttons && show(event));
  const MOVES = { ArrowLeft: [-0.04, 0], ArrowRight: [0.04, 0], ArrowUp: [0, -0.04], ArrowDown: [0, 0.04] };
  hand.addEventListener("keydown", (event) => {
    const move = MOVES[event.key];
    if (!isMine() || !move) return;
    event.preventDefault();
    moveHand((place ?? [0.5, 0.5]).map((c, axis) => c + move[axis]));
  });
  document.getElementById("away").addEventListener("click", () => moveHand(null));

  // Shows the attitude and the position of the hand that a page, possibly another one, has set
  // last.
  function showLast(motion) {
    attitude = motion.attitude;
    place = motion.hand;
    drawSensor();
    drawHand();
  }

  drawSensor();
  drawHand();
  return { show: showLast };
}
