// Uploads a model, a scene, a single texture or a program that the user drops on the page or chooses, as files or as a folder.
const CHUNK = 64 << 10;
const MAX_BYTES = 64 << 20;
// Maximum number of auxiliary files and maximum length of a name that the receiver accepts.
const MAX_BESIDE = 192;
const MAX_NAME = 100;
// Maximum size of a scene file that the page's URL carries.
const MAX_CARRIED = 4096;
// Maximum number of files and folders to search: a folder that was dropped by mistake may contain
// millions.
const MAX_ENTRIES = 20000;
// Auxiliary files of a mesh: materials of an OBJ, buffers of a glTF, pictures of textures.
const PICTURES = [".png", ".jpg", ".jpeg"];
const BESIDE = [".mtl", ".bin", ...PICTURES];
const TEXTURES = [".glt", ...PICTURES];
const WIREFRAMES = [".wft", ".wfb"];
const SCENES = [".toml"];
// A program of cargo has no extension.
const PROGRAMS = [".elf", ".bin", ""];
// Files that are no models.
const OTHERS = [...BESIDE, ...TEXTURES, ...WIREFRAMES, ...SCENES, ...PROGRAMS];

const extension = (path) => /[^/]*$/.exec(path)[0].match(/\.[^.]*$/)?.[0].toLowerCase() ?? "";
const depth = (path) => path.split("/").length;
const order = (a, b) => depth(a.path) - depth(b.path) || (a.path < b.path ? -1 : a.path > b.path ? 1 : 0);

// Returns all files with their paths. `entries` are files, or files and folders of a file system.
async function filesOf(entries) {
  const found = [];
  for (let i = 0; i < entries.length; i++) {
    const entry = entries[i];
    if (i >= MAX_ENTRIES) throw new Error(`expected the folder of a model, found one of more than ${MAX_ENTRIES} files`);
    if (entry.isDirectory) {
      const reader = entry.createReader();
      const read = () => new Promise((done, fail) => reader.readEntries(done, fail));
      // Each call returns the next entries; an empty list means that all entries were returned.
      for (let some = await read(); some.length > 0; some = await read()) entries.push(...some);
    } else if (entry.isFile) {
      const file = await new Promise((done, fail) => entry.file(done, fail));
      found.push({ path: entry.fullPath.replace(/^\/+/, ""), file });
    } else {
      found.push({ path: entry.webkitRelativePath || entry.name, file: entry });
    }
  }
  return found;
}

// Removes the folders that are common to all paths.
function withoutCommonFolders(files) {
  const [first, ...others] = files.map(({ path }) => path.split("/"));
  let shared = 0;
  while (shared < first.length - 1 && others.every((path) => shared < path.length - 1 && path[shared] === first[shared])) shared++;
  return files.map(({ path, file }) => ({ path: path.split("/").slice(shared).join("/"), file }));
}

// `carry` puts a scene into the page's URL, or removes what is there.
export function startUpload(send, sendBytes, notify, carry) {
  const bar = document.getElementById("progress");
  const inputs = { files: document.getElementById("file"), folder: document.getElementById("folder") };
  const MESHES = inputs.files.accept.split(",").filter((name) => !OTHERS.includes(name));
  // Files that a scene names, and their auxiliary files.
  const OF_SCENES = [...MESHES, ...BESIDE, ...TEXTURES, ...WIREFRAMES];

  // The scene or else the mesh nearest to the top folder, and its auxiliary files; or the only file, a texture or a program.
  function modelOf(found) {
    const sorted = found.sort(order);
    const nearest = (extensions) => sorted.find(({ path }) => extensions.includes(extension(path)));
    let mesh = nearest(MESHES);
    let scene = nearest(SCENES);
    if (mesh && scene && depth(mesh.path) < depth(scene.path)) scene = undefined;
    mesh = scene ?? mesh;
    const main = mesh ?? (sorted.length === 1 ? nearest([...TEXTURES, ...PROGRAMS]) : undefined);
    if (!main) {
      const names = sorted.slice(0, 3).map(({ path }) => path).join(", ");
      throw new Error(`expected a model (${MESHES.join(", ")}) or a scene (${SCENES.join(", ")}) and the files that it names, a single texture (${TEXTURES.join(", ")}) or a single program (.elf, .bin), found ${names || "no file"}`);
    }
    const named = scene ? OF_SCENES : BESIDE;
    const beside = mesh ? sorted.filter(({ path }) => named.includes(extension(path))) : [];
    const files = withoutCommonFolders([main, ...beside]);
    const size = files.reduce((sum, { file }) => sum + file.size, 0);
    const instead = "drop only the model or the scene and the files that it names";
    if (main.file.size === 0) throw new Error(`${main.path}: expected a model, a scene, a texture or a program, found an empty file`);
    if (files.length > MAX_BESIDE + 1) throw new Error(`expected at most ${MAX_BESIDE} files that belong to it, found ${files.length - 1}: ${instead}`);
    if (size > MAX_BYTES) throw new Error(`${main.path}: expected files of at most 64 MiB together, found ${size} bytes: ${instead}`);
    return files;
  }

  // `link` is what the page's URL carries, if it is known.
  async function upload(entries, link) {
    if (entries.length === 0) return;
    if (document.body.dataset.holder !== "you") return notify("Take control to upload a model, a scene or a program.");
    notify("");
    const contents = [];
    let heads;
    try {
      const files = modelOf(await filesOf(entries));
      for (const { path, file } of files) {
        const bytes = await file.arrayBuffer().catch(({ message }) => {
          throw new Error(`${path}: expected a file that the browser can read: ${message}`);
        });
        contents.push(bytes);
      }
      // Of a long path, only the last characters are sent.
      heads = files.map(({ path }, i) => ({ name: [...path].slice(-MAX_NAME).join(""), bytes: contents[i].byteLength }));
    } catch ({ message }) {
      return notify(message);
    }
    const [mesh, ...beside] = heads;
    const isCarried = SCENES.includes(extension(mesh.name)) && beside.length === 0 && mesh.bytes <= MAX_CARRIED;
    carry(...(link ?? (isCarried ? ["scene", new TextDecoder().decode(contents[0])] : [])));
    send({ type: "upload", ...mesh, beside });
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
    // The items are valid only during the event.
    const items = [...event.dataTransfer.items].filter(({ kind }) => kind === "file");
    upload(items.map((item) => item.webkitGetAsEntry?.() ?? item.getAsFile()).filter(Boolean));
  });
  for (const [name, input] of Object.entries(inputs)) {
    document.getElementById(`choose-${name}`).addEventListener("click", () => input.click());
    input.addEventListener("change", () => {
      upload([...input.files]);
      input.value = "";
    });
  }
  // Uploads a file of the page's own folder.
  const fetchFile = async (name) => {
    try {
      const response = await fetch(name);
      if (!response.ok) return notify(`${name}: expected a file beside the page, found status ${response.status}`);
      await upload([new File([await response.blob()], name)], ["program", name]);
    } catch ({ message }) {
      notify(`${name}: expected a file beside the page: ${message}`);
    }
  };
  // Uploads a scene file with this text.
  const sendScene = (text) => upload([new File([text], "link.toml")]);
  return { show, fetchFile, sendScene };
}
