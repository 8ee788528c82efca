// Uploads of mesh files, dropped on the page or chosen.
const CHUNK = 64 << 10;
const MAX_BYTES = 64 << 20;
// Auxiliary files of a mesh: materials of an OBJ, and buffers of a glTF.
const BESIDE = [".mtl", ".bin"];

export function startUpload(send, sendBytes, notify) {
  const bar = document.getElementById("progress");
  const choice = document.getElementById("file");
  const MESHES = choice.accept.split(",").filter((name) => !BESIDE.includes(name));

  const extension = ({ name }) => name.slice(name.lastIndexOf(".")).toLowerCase();
  // A name of at most 60 characters, with its end.
  const head = ({ name }, bytes) => ({ name: [...name].slice(-60).join(""), bytes: bytes.byteLength });

  // Uploads the first mesh of the files, with its materials and buffers.
  async function upload(files) {
    const mesh = files.find((file) => MESHES.includes(extension(file))) ?? files[0];
    if (!mesh) return;
    const all = [mesh, ...files.filter((file) => file !== mesh && BESIDE.includes(extension(file)))];
    if (document.body.dataset.holder !== "you") return notify("Take control to upload a model.");
    const size = all.reduce((sum, file) => sum + file.size, 0);
    if (mesh.size === 0 || size > MAX_BYTES) return notify(`${mesh.name}: expected 1 byte to 64 MiB, found ${size} bytes`);
    const contents = [];
    for (const file of all) {
      try {
        contents.push(await file.arrayBuffer());
      } catch (error) {
        return notify(`${file.name}: expected a file that the browser can read: ${error.message}`);
      }
    }
    const [own, ...beside] = all.map((file, number) => head(file, contents[number]));
    send({ type: "upload", ...own, beside });
    for (const bytes of contents) {
      for (let start = 0; start < bytes.byteLength; start += CHUNK) sendBytes(bytes.slice(start, start + CHUNK));
    }
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
    upload([...event.dataTransfer.files]);
  });
  choice.addEventListener("change", () => {
    upload([...choice.files]);
    choice.value = "";
  });
  return show;
}
