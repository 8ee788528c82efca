// Uploads of mesh files, dropped on the page or chosen.
const CHUNK = 64 << 10;
const MAX_BYTES = 64 << 20;

export function startUpload(send, sendBytes, notify) {
  const bar = document.getElementById("progress");

  async function upload(file) {
    if (document.body.dataset.holder !== "you") return notify("Take control to upload a model.");
    if (file.size === 0 || file.size > MAX_BYTES) return notify(`${file.name}: expected 1 byte to 64 MiB, found ${file.size} bytes`);
    const bytes = await file.arrayBuffer();
    send({ type: "upload", name: file.name.slice(-60), bytes: bytes.byteLength });
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
    upload(event.dataTransfer.files[0]);
  });
  const choice = document.getElementById("file");
  choice.addEventListener("change", () => {
    if (choice.files[0]) upload(choice.files[0]);
    choice.value = "";
  });
  return show;
}
