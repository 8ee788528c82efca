//! Meshes that are dropped on the page: the picture is that of `glint render`, whatever was shown before.

use crate::browser::{Browser, Page};
use crate::page::wait_for_pixels;
use crate::served::Served;
use std::path::Path;
use std::process::Command;

/// A tetrahedron with two materials.
const OBJ: &str = "mtllib corner.mtl\nv 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 1\nusemtl red\nf 1 3 2\nf 1 2 4\nusemtl green\nf 2 3 4\nf 3 1 4\n";
const MTL: &str = "newmtl red\nKd 1 0.2 0.1\nnewmtl green\nKd 0.1 0.8 0.2\n";
/// A triangle.
const STL: &str = "solid a\nfacet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 2\nendloop\nendfacet\nendsolid a\n";

/// Drops files on the page, and waits for the notice about the shown model, which it returns.
fn drop_files(browser: &mut Browser, page: &Page, files: &[(&str, &str)]) -> String {
    let items: String = files
        .iter()
        .map(|(name, text)| format!("data.items.add(new File([{text:?}], '{name}')); "))
        .collect();
    let event = "new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true })";
    browser.evaluate(
        page,
        &format!(
            "{{ const data = new DataTransfer(); {items} document.body.dispatchEvent({event}); }} 0"
        ),
    );
    let notice = "document.getElementById('notice')";
    browser.wait(
        page,
        &format!(
            "{notice}.role === 'status' && {notice}.textContent.startsWith('the model is shown')"
        ),
    );
    let text = browser.evaluate(page, &format!("{notice}.textContent"));
    text.as_str().unwrap().to_owned()
}

/// The pixels of `glint render FILE` as red, green, blue and opacity.
fn rendered(folder: &Path, file: &str) -> Vec<u8> {
    let picture = folder.join("picture.png");
    let status = Command::new(env!("CARGO_BIN_EXE_glint"))
        .args(["render", file, "--force", "--out"])
        .arg(&picture)
        .current_dir(folder)
        .output()
        .unwrap()
        .status;
    assert!(status.success());
    let file = std::io::BufReader::new(std::fs::File::open(picture).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    let pixels = pixels.as_chunks().0.iter();
    pixels.flat_map(|&[r, g, b]| [r, g, b, 255]).collect()
}

#[test]
fn a_dropped_mesh_is_the_picture_of_glint_render() {
    let served = Served::start("page-upload");
    let mut browser = Browser::start();
    let page = browser.open(&served.url);
    browser.wait(&page, "document.body.dataset.holder === 'you'");
    browser.wait(
        &page,
        "/yaw -?[0-9]/.test(document.querySelector('#curve-attitude figcaption').textContent)",
    );
    let folder = tempfile::tempdir().unwrap();
    for (files, remark) in [
        (&[("corner.mtl", MTL), ("corner.obj", OBJ)][..], ""),
        (&[("alone.obj", OBJ)], "no material file"),
        (&[("flat.stl", STL)], ""),
    ] {
        browser.evaluate(&page, "document.getElementById('line').focus()");
        for line in ["scene cubes", "imu look"] {
            browser.type_line(&page, line);
        }
        browser.evaluate(&page, "document.getElementById('sensor').focus()");
        for _ in 0..4 {
            browser.press(&page, "ArrowRight", "");
        }
        let notice = drop_files(&mut browser, &page, files);
        assert!(notice.contains(remark), "{notice}");
        assert_eq!(remark.is_empty(), !notice.contains(';'), "{notice}");
        let (name, _) = files[files.len() - 1];
        for (name, text) in files {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        if files.len() == 1 {
            // As on the page, the material file is missing.
            let _ = std::fs::remove_file(folder.path().join("corner.mtl"));
        }
        wait_for_pixels(&mut browser, &page, &rendered(folder.path(), name));
    }
    // The model is among the meshes.
    browser.wait(
        &page,
        "[...document.querySelectorAll('#meshes button')].some(({ textContent }) => textContent === 'model')",
    );
}

/// `glint upload` shows the whole mesh too, or keeps the scene.
#[test]
fn glint_upload_shows_the_whole_mesh() {
    let port = Served::start_with("page-upload-port", &[]);
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [("corner.obj", OBJ), ("corner.mtl", MTL)] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
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
