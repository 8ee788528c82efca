// Uploads of mesh files, dropped on the page or chosen.
const CHUNK = 64 << 10;
const MAX_BYTES = 64 << 20;

export function startUpload(send, sendBytes, notify) {
  const bar = document.getElementById("progress");
  const choice = document.getElementById("file");
  const FORMATS = choice.accept.split(",");

  async function upload(file) {
    if (document.body.dataset.holder !== "you") return notify("Take control to upload a model.");
    if (file.size === 0 || file.size > MAX_BYTES) return notify(`${file.name}: expected 1 byte to 64 MiB, found ${file.size} bytes`);
    let bytes;
    try {
      bytes = await file.arrayBuffer();
    } catch (error) {
      return notify(`${file.name}: expected a file that the browser can read: ${error.message}`);
    }
    send({ type: "upload", name: [...file.name].slice(-60).join(""), bytes: bytes.byteLength });
    for (let start = 0; start < bytes.byteLength; start += CHUNK) sendBytes(bytes.slice(start, start + CHUNK));
  }

  const show = ({ done, all }) => {
    bar.hidden = done >= all;
    [bar.max, bar.value] = [all, done];
  };
  const hasFile = (event) => [...(event.dataTransfer?.types ?? [])].includes("Files");
  addEventListener("dragover", (event) => hasFile(event) && event.preventDefault());
  addEventListener("drop", (event) => {
    if (!hasFile(event)) return;
    event.preventDefault();
    const files = [...event.dataTransfer.files];
    const mesh = files.find(({ name }) => FORMATS.includes(name.slice(name.lastIndexOf(".")).toLowerCase()));
    upload(mesh ?? files[0]);
  });
  choice.addEventListener("change", () => {
    if (choice.files[0]) upload(choice.files[0]);
    choice.value = "";
  });
  return show;
}
