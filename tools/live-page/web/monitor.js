// The monitor: draws pictures of RGB565 colours, and counts the pictures.
const HEAD = 8;
const canvas = document.getElementById("monitor");
const context = canvas.getContext("2d", { alpha: false });
const rate = document.getElementById("rate");
let image;
let times = [];

// Widens a colour by repeating its upper bits, as the board's video output does.
const COLOURS = Uint32Array.from({ length: 65536 }, (_, colour) => {
  const [r, g, b] = [colour >> 11, (colour >> 5) & 63, colour & 31];
  return ((255 << 24) | (((b << 3) | (b >> 2)) << 16) | (((g << 2) | (g >> 4)) << 8) | ((r << 3) | (r >> 2))) >>> 0;
});

// Draws each pixel as a square if it is at least two pixels of the screen wide. With a smaller factor, squares would have unequal widths,
// which would make smooth edges jagged.
function chooseScaling() {
  const factor = (canvas.clientWidth * devicePixelRatio) / canvas.width;
  canvas.classList.toggle("squares", factor >= 2);
}

new ResizeObserver(chooseScaling).observe(canvas);

// Draws the picture of a binary message.
export function showPicture(data) {
  const head = new DataView(data);
  const [width, height] = [head.getUint16(0, true), head.getUint16(2, true)];
  if (!image || image.width !== width || image.height !== height) {
    [canvas.width, canvas.height] = [width, height];
    chooseScaling();
    image = context.createImageData(width, height);
  }
  const pixels = new Uint16Array(data, HEAD, width * height);
  const out = new Uint32Array(image.data.buffer);
  for (let i = 0; i < pixels.length; i++) out[i] = COLOURS[pixels[i]];
  context.putImageData(image, 0, 0);
  canvas.dataset.number = head.getUint32(4, true);
  times.push(performance.now());
}

// Clears the picture of an earlier board.
export function clearPicture() {
  context.clearRect(0, 0, canvas.width, canvas.height);
}

function showRate() {
  const start = performance.now() - 1000;
  times = times.filter((time) => time > start);
  rate.textContent = times.length > 0 ? `${times.length} pictures/s` : "still";
}

setInterval(showRate, 500);
