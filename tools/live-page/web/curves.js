// Curves over time: duration of a frame, cycles of the engine, attitude of the sensor.
const SHOWN_MS = 60_000;
const COLOURS = ["#3a9bff", "#ff8a3c", "#3fbf7f"];
// `least` is the minimum height of a curve's range, so that noise does not fill the curve.
const CURVES = [
  { id: "time", unit: "ms", least: [0, 1], names: ["frame"], values: ({ stats }) => [stats && (stats.cycles / stats.clock) * 1000] },
  { id: "engine", unit: "kcycles", least: [0, 1], names: ["busy", "stalled"], values: ({ stats }) => [stats?.cycles_busy, stats?.cycles_stalled].map((c) => c / 1000) },
  { id: "attitude", unit: "°", least: [-10, 10], names: ["yaw", "pitch", "roll"], values: ({ attitude }) => (attitude ? angles(attitude) : []) },
];

function angles([w, x, y, z]) {
  const yaw = Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
  const pitch = Math.asin(Math.min(Math.max(2 * (w * y - z * x), -1), 1));
  const roll = Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y));
  return [yaw, pitch, roll].map((angle) => (angle * 180) / Math.PI);
}

// Draws the values of the samples of the last minute before `now`.
function draw(canvas, samples, now, count, least) {
  const context = canvas.getContext("2d");
  const { width, height } = canvas;
  const all = samples.flatMap(({ found }) => found).filter(Number.isFinite);
  const [low, high] = [Math.min(least[0], ...all), Math.max(least[1], ...all)];
  context.clearRect(0, 0, width, height);
  for (let number = 0; number < count; number++) {
    context.strokeStyle = COLOURS[number];
    context.lineWidth = 2;
    context.beginPath();
    for (const { at, found } of samples) {
      const value = found[number];
      if (Number.isFinite(value)) context.lineTo(width * (1 - (now - at) / SHOWN_MS), height - 3 - ((value - low) / (high - low)) * (height - 6));
    }
    context.stroke();
  }
}

// Formats a number with one decimal, and without the minus sign of a value that rounds to zero.
const decimal = (value) => (Number.isFinite(value) ? (Math.round(value * 10) / 10 || 0).toFixed(1) : "–");

export function startCurves() {
  const curves = CURVES.map((curve) => ({ ...curve, samples: [], figure: document.getElementById(`curve-${curve.id}`) }));
  return (sample) => {
    const now = performance.now();
    for (const { figure, names, unit, least, values, samples } of curves) {
      const found = values(sample);
      samples.push({ at: now, found });
      while (now - samples[0].at > SHOWN_MS) samples.shift();
      draw(figure.querySelector("canvas"), samples, now, names.length, least);
      const texts = names.map((name, number) => {
        const text = document.createElement("span");
        text.style.borderColor = COLOURS[number];
        text.textContent = `${name} ${decimal(found[number])} ${unit}`;
        return text;
      });
      figure.querySelector("figcaption").replaceChildren(...texts);
    }
  };
}
