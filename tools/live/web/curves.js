// Curves over time: of a frame, of the engines' cycles, of the attitude.
const SAMPLES = 240;
const COLOURS = ["#3a9bff", "#ff8a3c", "#3fbf7f"];
const CURVES = [
  { id: "time", unit: "ms", names: ["frame"], values: ({ stats }) => [stats && (stats.cycles / stats.clock) * 1000] },
  { id: "engine", unit: "kcycles", names: ["busy", "stalled"], values: ({ stats }) => [stats?.cycles_busy, stats?.cycles_stalled].map((c) => c / 1000) },
  { id: "attitude", unit: "°", names: ["yaw", "pitch", "roll"], values: ({ attitude }) => (attitude ? angles(attitude) : []) },
];

function angles([w, x, y, z]) {
  const yaw = Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
  const pitch = Math.asin(Math.min(Math.max(2 * (w * y - z * x), -1), 1));
  const roll = Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y));
  return [yaw, pitch, roll].map((angle) => (angle * 180) / Math.PI);
}

function draw(canvas, series) {
  const context = canvas.getContext("2d");
  const { width, height } = canvas;
  const all = series.flat().filter(Number.isFinite);
  const [low, high] = [Math.min(0, ...all), Math.max(1e-6, ...all)];
  context.clearRect(0, 0, width, height);
  series.forEach((values, number) => {
    context.strokeStyle = COLOURS[number];
    context.lineWidth = 2;
    context.beginPath();
    values.forEach((value, i) => {
      if (Number.isFinite(value)) context.lineTo((i / (SAMPLES - 1)) * width, height - 3 - ((value - low) / (high - low)) * (height - 6));
    });
    context.stroke();
  });
}

export function startCurves() {
  const curves = CURVES.map((curve) => ({ ...curve, series: curve.names.map(() => []), figure: document.getElementById(`curve-${curve.id}`) }));
  return (sample) => {
    for (const { figure, names, unit, values, series } of curves) {
      const found = values(sample);
      series.forEach((list, number) => {
        list.push(found[number] ?? NaN);
        if (list.length > SAMPLES) list.shift();
      });
      draw(figure.querySelector("canvas"), series);
      const texts = names.map((name, number) => {
        const text = document.createElement("span");
        text.style.borderColor = COLOURS[number];
        text.textContent = `${name} ${Number.isFinite(found[number]) ? found[number].toFixed(1) : "–"} ${unit}`;
        return text;
      });
      figure.querySelector("figcaption").replaceChildren(...texts);
    }
  };
}
