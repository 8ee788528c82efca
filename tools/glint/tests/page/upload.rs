//! The picture of a model or a scene that is dropped on the page equals the picture of `glint render`,
//! whatever the page has shown before.

use crate::browser::{Browser, Page};
use crate::page::wait_for_pixels;
use crate::served::Served;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glint_texture::picture::Picture;
use serde_json::json;
use std::path::Path;
use std::process::Command;

/// A tetrahedron with two materials.
const OBJ: &[u8] = b"mtllib corner.mtl\nv 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 1\nusemtl red\nf 1 3 2\nf 1 2 4\nusemtl green\nf 2 3 4\nf 3 1 4\n";
const MTL: &[u8] = b"newmtl red\nKd 1 0.2 0.1\nnewmtl green\nKd 0.1 0.8 0.2\n";
/// A triangle.
const STL: &[u8] = b"solid a\nfacet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 2\nendloop\nendfacet\nendsolid a\n";

/// A scene with this mesh, a generated and a built-in one, and a replacement texture.
const SCENE: &str = "title = 'Corners'\nobject = ['corner.obj', 'icosphere:2 move 1,0,0', 'crate scale 0.5 move 0,1,0']\n\
    texture = 'squares.png'\ncamera = '4 20 60'\nfov = 50\nbackground = '203040'\n";

/// A rectangle with a texture, whose file is in a folder.
const SIGN: &[u8] = b"mtllib sign.mtl\nusemtl sign\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
const SIGN_MTL: &[u8] = b"newmtl sign\nKd 1 1 1\nmap_Kd pictures\\sign.png\n";

/// Paths and contents of the files of a folder.
type Files = Vec<(&'static str, Vec<u8>)>;

fn files(files: &[(&'static str, &[u8])]) -> Files {
    let files = files.iter();
    files.map(|&(name, bytes)| (name, bytes.into())).collect()
}

/// A picture of coloured squares.
fn squares() -> Vec<u8> {
    let picture = Picture::drawn([32, 32], |x, y| {
        let [s, t] = [x / 8, y / 8].map(|c| c as u8);
        [64 * s, 80 * t, if (s + t) % 2 == 0 { 255 } else { 40 }, 255]
    });
    picture.png().unwrap()
}

/// A square as a glTF, with a buffer and a picture in separate files.
fn square() -> Files {
    let positions: [[f32; 3]; 4] = [
        [-1.0, -1.0, 0.0],
        [1.0, -1.0, 0.0],
        [1.0, 1.0, 0.0],
        [-1.0, 1.0, 0.0],
    ];
    let coordinates: [[f32; 2]; 4] = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let numbers = positions
        .as_flattened()
        .iter()
        .chain(coordinates.as_flattened());
    let mut buffer: Vec<u8> = numbers.flat_map(|number| number.to_le_bytes()).collect();
    buffer.extend([0, 1, 2, 0, 2, 3]);
    let gltf = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "uri": "square%20a.bin", "byteLength": buffer.len() }],
        "bufferViews": [
            { "buffer": 0, "byteLength": 48 },
            { "buffer": 0, "byteOffset": 48, "byteLength": 32 },
            { "buffer": 0, "byteOffset": 80, "byteLength": 6 },
        ],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3" },
            { "bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2" },
            { "bufferView": 2, "componentType": 5121, "count": 6, "type": "SCALAR" },
        ],
        "images": [{ "uri": "pictures/squares.png" }],
        "textures": [{ "source": 0 }],
        "materials": [{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
        "meshes": [{ "primitives": [{
            "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2, "material": 0
        }] }],
        "nodes": [{ "mesh": 0 }],
        "scenes": [{ "nodes": [0] }],
    });
    vec![
        ("square.gltf", gltf.to_string().into()),
        ("square a.bin", buffer),
        ("pictures/squares.png", squares()),
    ]
}

/// Drops files on the page, without their folders.
pub fn drop_files(browser: &mut Browser, page: &Page, files: &[(&str, Vec<u8>)]) {
    let items: String = files
        .iter()
        .map(|(path, bytes)| {
            let name = path.rsplit('/').next().unwrap();
            let text = STANDARD.encode(bytes);
            format!(
                "data.items.add(new File([Uint8Array.from(atob('{text}'), (c) => c.charCodeAt(0))], '{name}')); "
            )
        })
        .collect();
    let event = "new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true })";
    browser.evaluate(
        page,
        &format!(
            "{{ const data = new DataTransfer(); {items} document.body.dispatchEvent({event}); }} 0"
        ),
    );
}

/// Waits for a notice that begins with a text, and returns it.
pub fn wait_for_notice(browser: &mut Browser, page: &Page, start: &str) -> String {
    let notice = "document.getElementById('notice')";
    browser.wait(page, &format!("{notice}.textContent.startsWith({start:?})"));
    let text = browser.evaluate(page, &format!("{notice}.textContent"));
    text.as_str().unwrap().to_owned()
}

const SHOWN: &str = "the model is shown";

/// The pixels of `glint render FILE` as red, green, blue and opacity.
pub fn rendered(folder: &Path, arguments: &[&str]) -> Vec<u8> {
    let picture = folder.join("picture.png");
    let output = Command::new(env!("CARGO_BIN_EXE_glint"))
        .arg("render")
        .args(arguments)
        .args(["--force", "--out"])
        .arg(&picture)
        .current_dir(folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    let picture = Picture::decode(&std::fs::read(picture).unwrap()).unwrap();
    picture.texels.concat()
}

/// A folder with these files.
fn folder_of(files: &[(&str, Vec<u8>)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    folder
}

/// Opens the page of a board, and waits for control and the first measurement.
fn open(browser: &mut Browser, served: &Served) -> Page {
    let page = browser.open(&served.url);
    browser.wait(&page, "document.body.dataset.holder === 'you'");
    browser.wait(
        &page,
        "/yaw -?[0-9]/.test(document.querySelector('#curve-attitude figcaption').textContent)",
    );
    page
}

#[test]
fn a_dropped_mesh_is_the_picture_of_glint_render() {
    let served = Served::start("page-upload");
    let mut browser = Browser::start();
    let page = open(&mut browser, &served);
    for (files, remark) in [
        (files(&[("corner.mtl", MTL), ("corner.obj", OBJ)]), ""),
        (
            files(&[("alone.obj", OBJ)]),
            "no material file 'corner.mtl' beside the mesh: its colours are missing; \
             drop 'alone.obj' together with 'corner.mtl', or drop their folder",
        ),
        (files(&[("flat.stl", STL)]), ""),
    ] {
        browser.evaluate(&page, "document.getElementById('line').focus()");
        for line in ["scene cubes", "imu look"] {
            browser.type_line(&page, line);
        }
        browser.evaluate(&page, "document.getElementById('sensor').focus()");
        for _ in 0..4 {
            browser.press(&page, "ArrowRight", "");
        }
        drop_files(&mut browser, &page, &files);
        let notice = wait_for_notice(&mut browser, &page, SHOWN);
        assert!(notice.contains(remark), "{notice}");
        assert_eq!(remark.is_empty(), !notice.contains(';'), "{notice}");
        let (name, _) = files[files.len() - 1];
        let folder = folder_of(&files);
        wait_for_pixels(&mut browser, &page, &rendered(folder.path(), &[name]));
    }
    let mut scene = files(&[("corner.obj", OBJ), ("corner.mtl", MTL)]);
    scene.push(("own.toml", SCENE.into()));
    scene.push(("squares.png", squares()));
    drop_files(&mut browser, &page, &scene);
    let notice = wait_for_notice(&mut browser, &page, "the scene own.toml is shown");
    assert!(!notice.contains(';'), "{notice}");
    let shown = rendered(folder_of(&scene).path(), &["--scene", "own.toml"]);
    wait_for_pixels(&mut browser, &page, &shown);
    // A missing or wrong file of a scene leaves the picture.
    drop_files(&mut browser, &page, &scene[1..]);
    wait_for_notice(
        &mut browser,
        &page,
        "expected the file corner.obj of the scene; drop 'own.toml' together with 'corner.obj'",
    );
    let wrong = SCENE.replace("fov = 50", "fov = 500");
    drop_files(&mut browser, &page, &[("own.toml", wrong.into())]);
    wait_for_notice(&mut browser, &page, "own.toml: line 5: ");
    wait_for_pixels(&mut browser, &page, &shown);

    let net = std::fs::read(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/pictures/wireframe.wft"),
    );
    let scene = [
        (
            "net.toml",
            b"title = 'A net'\nprogram = 'wireframe.wft'\nsize = '320 180'\n".to_vec(),
        ),
        ("wireframe.wft", net.unwrap()),
    ];
    drop_files(&mut browser, &page, &scene);
    wait_for_notice(&mut browser, &page, "the scene net.toml is shown");
    let shown = rendered(folder_of(&scene).path(), &["--scene", "net.toml"]);
    wait_for_pixels(&mut browser, &page, &shown);
    // The list of meshes contains the model.
    browser.wait(
        &page,
        "[...document.querySelectorAll('#meshes button')].some(({ textContent }) => textContent === 'model')",
    );
}

/// Models with textures are dropped as files and as a folder.
#[test]
fn a_dropped_model_has_its_textures() {
    let served = Served::start("page-textures");
    let mut browser = Browser::start();
    let page = open(&mut browser, &served);
    let sign = files(&[
        ("sign.obj", SIGN),
        ("sign.mtl", SIGN_MTL),
        ("pictures/sign.png", &squares()),
        ("readme.txt", b"a sign"),
    ]);
    let models = [("sign.obj", sign), ("square.gltf", square())];
    let mut shown = Vec::new();
    for (name, files) in &models {
        let folder = folder_of(files);
        let textured = rendered(folder.path(), &[name]);
        assert_ne!(textured, rendered(folder.path(), &[name, "--no-textures"]));
        drop_files(&mut browser, &page, files);
        let notice = wait_for_notice(&mut browser, &page, SHOWN);
        assert!(!notice.contains(';'), "{notice}");
        wait_for_pixels(&mut browser, &page, &textured);
        shown.push((folder, textured));
    }
    assert_ne!(shown[0].1, shown[1].1);

    // The folder of the first model, as a user drops it.
    let (folder, textured) = &shown[0];
    let place = browser.middle(&page, "#model");
    browser.drop_paths(&page, place, &[folder.path()]);
    wait_for_pixels(&mut browser, &page, textured);
    let notice = wait_for_notice(&mut browser, &page, SHOWN);
    assert!(!notice.contains(';'), "{notice}");

    // Files and a folder of the second model are dropped together.
    let (folder, textured) = &shown[1];
    let paths = ["square.gltf", "square a.bin", "pictures"].map(|name| folder.path().join(name));
    browser.drop_paths(&page, place, &paths);
    wait_for_pixels(&mut browser, &page, textured);

    // The buttons choose the same files.
    for (number, selector) in [(0, "#folder"), (1, "#file")] {
        let (folder, textured) = &shown[number];
        let files = models[number].1.iter();
        let files = files.map(|(name, _)| folder.path().join(name)).collect();
        let paths = if number == 0 {
            vec![folder.path().to_owned()]
        } else {
            files
        };
        browser.choose_paths(&page, selector, &paths);
        wait_for_pixels(&mut browser, &page, textured);
    }

    // The notice names a missing file. A glTF without its buffer is not shown.
    let (_, gltf) = &models[1];
    drop_files(&mut browser, &page, &gltf[..2]);
    let notice = wait_for_notice(&mut browser, &page, SHOWN);
    let hint = "drop 'square.gltf' together with";
    assert!(
        notice.ends_with(&format!(
            "expected the file of an image in the folder of the glTF, found 'pictures/squares.png': \
             its surfaces keep their base colours; {hint} 'pictures/squares.png', or drop their folder"
        )),
        "{notice}"
    );
    for (files, line) in [
        (
            &gltf[..1],
            format!(
                "square.gltf: expected the file of a buffer in the folder of the glTF, found 'square%20a.bin'; \
                 {hint} 'square a.bin', or drop their folder"
            ),
        ),
        (
            &gltf[1..],
            "expected a model (.obj, .stl, .ply, .gltf, .glb, .glm) or a scene (.toml) and the files that it names, \
             a single texture (.glt, .png, .jpg, .jpeg) or a single program (.elf, .bin), found square a.bin, squares.png"
                .into(),
        ),
    ] {
        drop_files(&mut browser, &page, files);
        let notice = wait_for_notice(&mut browser, &page, &line[..11]);
        assert_eq!(notice, line);
    }
}

/// The model of docs/first-steps.md, and then with another texture. With the environment variable `GLINT_UPDATE`, its screenshot is replaced.
#[test]
fn the_model_of_the_first_steps_can_be_dropped() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let text = std::fs::read_to_string(docs.join("first-steps.md")).unwrap();
    let block = |start: &str| {
        let (_, rest) = text.split_once(start).unwrap();
        let (block, _) = rest.split_once("```").unwrap();
        block.as_bytes()
    };
    let sponge = std::fs::read(docs.join("pictures/first-sponge.png")).unwrap();
    let files = files(&[
        ("box.obj", block("Save it as `box.obj`:\n\n```obj\n")),
        ("box.mtl", block("Save it as `box.mtl`:\n\n```mtl\n")),
        ("sponge.png", &sponge),
    ]);
    let folder = folder_of(&files);
    let served = Served::start("page-first-steps");
    let mut browser = Browser::start();
    let page = open(&mut browser, &served);
    drop_files(&mut browser, &page, &files);
    let textured = rendered(folder.path(), &["box.obj"]);
    wait_for_pixels(&mut browser, &page, &textured);
    if std::env::var_os("GLINT_UPDATE").is_some() {
        std::fs::write(docs.join("pictures/first-page.png"), browser.picture(&page)).unwrap();
    }
    std::fs::write(folder.path().join("squares.png"), squares()).unwrap();
    drop_files(&mut browser, &page, &[("squares.png", squares())]);
    let notice = wait_for_notice(&mut browser, &page, "the texture squares.png is uploaded: ");
    assert!(!notice.contains("no shown mesh"), "{notice}");
    let replaced = rendered(folder.path(), &["box.obj", "--texture", "squares.png"]);
    assert!(replaced != textured);
    wait_for_pixels(&mut browser, &page, &replaced);
}

/// `glint upload` shows the whole mesh, like the page; with `--keep-scene` it keeps the scene.
#[test]
fn glint_upload_shows_the_whole_mesh() {
    let port = Served::start_with("page-upload-port", &[]);
    let folder = folder_of(&files(&[("corner.obj", OBJ), ("corner.mtl", MTL)]));
    let glint = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_glint"))
            .args(arguments)
            .current_dir(&folder)
            .output()
            .unwrap();
        assert!(output.status.success(), "{arguments:?}: {output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let send = |commands: &[&str]| {
        let sent = commands.iter().flat_map(|command| ["--send", command]);
        let arguments: Vec<_> = ["console", &port.url].into_iter().chain(sent).collect();
        glint(&arguments)
    };
    let upload = ["upload", "corner.obj", "--board", &port.url, "--keep-scene"];
    let state = ["view", "background", "field"];

    send(&["scene cubes"]);
    glint(&upload[..4]);
    let shown = send(&state);
    send(&["scene default", "scene corner", "fit y"]);
    assert_eq!(shown, send(&state));

    send(&["scene cubes", "field off"]);
    let before = send(&state);
    glint(&upload);
    assert_eq!(before, send(&state));
}
