//! Checks that the commands of README.md, docs/first-steps.md and docs/gallery.md make the pictures
//! of these pages. Requires the build of `cargo xtask firmware`. If the environment variable
//! `GLINT_UPDATE` is set, the pictures of docs/ are replaced.

use glint_core::field::KINDS;
use std::collections::HashMap;
use std::ffi::OsStr;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Maximum total size of the pictures of a page in bytes.
const MAX_BYTES: u64 = 1_800_000;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn page(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap()
}

/// Creates a folder for a test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn updates() -> bool {
    std::env::var_os("GLINT_UPDATE").is_some()
}

/// Runs a command in a folder, and replaces existing output files.
fn glint(folder: &Path, arguments: &[impl AsRef<OsStr> + std::fmt::Debug]) -> Output {
    let output = Command::new(env!("CARGO_BIN_EXE_glint"))
        .args(arguments)
        .arg("--force")
        .current_dir(folder)
        .output()
        .unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {error}");
    output
}

/// The arguments of a command line. Quotes join words.
fn words(command: &str) -> Vec<&str> {
    let parts = command.split('"').enumerate();
    let words = parts.flat_map(|(i, part)| match i % 2 {
        0 => part.split_whitespace().collect(),
        _ => vec![part],
    });
    words.collect()
}

/// The value of `option` in a command.
fn value<'a>(command: &[&'a str], option: &str) -> Option<&'a str> {
    let at = command.iter().position(|word| *word == option)?;
    command.get(at + 1).copied()
}

/// The pixels of all frames of a picture or an animation.
fn pixels(path: &Path) -> Vec<u8> {
    let file = BufReader::new(File::open(path).unwrap_or_else(|error| panic!("{path:?}: {error}")));
    let mut pixels = Vec::new();
    if path.extension().is_some_and(|extension| extension == "gif") {
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(file).unwrap();
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            pixels.extend_from_slice(&frame.buffer);
        }
    } else {
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        pixels.resize(reader.output_buffer_size().unwrap(), 0);
        reader.next_frame(&mut pixels).unwrap();
    }
    pixels
}

/// Checks that the pictures of a page equal the generated pictures, and that their total size is
/// small. Each pair is a generated picture and the picture of the page.
fn check_pictures(pictures: &[(PathBuf, PathBuf)]) {
    let mut bytes = 0;
    for (made, shown) in pictures {
        if updates() {
            std::fs::copy(made, shown).unwrap();
        }
        assert!(
            pixels(made) == pixels(shown),
            "{shown:?}: `GLINT_UPDATE=1 cargo test -p glint --test documents` replaces the pictures"
        );
        bytes += std::fs::metadata(shown).unwrap().len();
    }
    assert!(bytes < MAX_BYTES, "{bytes} bytes of pictures");
}

/// Commands of docs/first-steps.md that are not run here, because other tests cover packaging, the
/// firmware and the live page.
const NOT_RUN: [&str; 3] = [
    "cargo install --path tools/glint",
    "cargo xtask firmware",
    "glint board --web",
];

/// The code blocks of a page in a language.
fn blocks<'a>(page: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    let blocks = page.split(&fence).skip(1);
    blocks
        .filter_map(|rest| Some(rest.split_once("```")?.0))
        .collect()
}

#[test]
fn the_first_steps_make_their_pictures() {
    let folder = folder("first-steps");
    let page = page("docs/first-steps.md");
    let models = ["obj", "mtl"].map(|language| blocks(&page, language));
    let ([house, r#box], [material]) = (&models[0][..], &models[1][..]) else {
        panic!("two models, one with a material file");
    };
    for (name, text) in [
        ("house.obj", house),
        ("box.obj", r#box),
        ("box.mtl", material),
    ] {
        std::fs::write(folder.join(name), text).unwrap();
    }
    let mut pictures = Vec::new();
    for command in blocks(&page, "sh").into_iter().flat_map(str::lines) {
        if NOT_RUN.contains(&command) {
            continue;
        }
        let arguments = command.strip_prefix("glint ").expect(command);
        let arguments = words(arguments);
        let output = glint(&folder, &arguments);
        assert!(!output.stdout.is_empty(), "{command}");
        let error = String::from_utf8(output.stderr).unwrap();
        let mut lines = error.lines();
        assert!(
            lines.all(|line| line.starts_with("note: ") || line.starts_with("drawing: ")),
            "{command}: {error}"
        );
        if let Some(name) = value(&arguments, "--out") {
            let shown = format!("pictures/first-{name}");
            assert!(page.contains(&format!("]({shown})")), "{shown}");
            pictures.push((folder.join(name), root().join("docs").join(shown)));
        }
    }
    assert_eq!(pictures.len(), 7);
    check_pictures(&pictures);
}

/// The `glint …` commands in docs/gallery.md; a `\` continues a line.
fn gallery(page: &str) -> Vec<Vec<&str>> {
    let commands = page.lines().filter_map(|line| line.strip_prefix("glint "));
    commands.map(words).collect()
}

#[test]
fn the_gallery_has_its_pictures() {
    let folder = folder("gallery");
    let page = page("docs/gallery.md").replace("\\\n", " ");
    let mut pictures = Vec::new();
    for (number, command) in gallery(&page).into_iter().enumerate() {
        let out = value(&command, "--out").unwrap();
        let [made, stats] = ["png", "json"].map(|end| folder.join(format!("{number}.{end}")));
        let moved = |word| match word == out {
            true => made.as_os_str(),
            false => OsStr::new(word),
        };
        let mut arguments: Vec<_> = command.iter().map(|word| moved(*word)).collect();
        arguments.extend([OsStr::new("--stats"), stats.as_os_str()]);
        glint(&root(), &arguments);
        let stats = std::fs::read(&stats).unwrap();
        let stats: serde_json::Value = serde_json::from_slice(&stats).unwrap();
        // Only the picture of a field has rays.
        assert!(
            matches!(stats["undecided"].as_u64(), None | Some(0)),
            "{command:?}: undecided rays are visible"
        );
        let shown = root().join(out);
        pictures.push((made, shown));
    }
    check_pictures(&pictures);
}

#[test]
fn every_field_has_a_picture() {
    let page = page("docs/gallery.md").replace("\\\n", " ");
    let commands = gallery(&page);
    let shown = commands
        .iter()
        .filter_map(|command| value(command, "--field"));
    let shown: Vec<_> = shown.map(|field| field.split(':').next()).collect();
    for (form, _) in KINDS {
        let kind = form.split(':').next();
        assert!(
            shown.contains(&kind),
            "docs/gallery.md has no picture of {form}"
        );
    }
}

/// The `glint` commands of the section "Models and fields" of README.md that run without a board.
fn readme(page: &str) -> Vec<Vec<&str>> {
    let (_, section) = page.split_once("## Models and fields").unwrap();
    let (section, _) = section.split_once("\n## ").unwrap();
    let lines = section
        .lines()
        .filter(|line| line.starts_with("cargo run -p glint"));
    let commands = lines
        .map(|line| line.split_once('#').map_or(line, |(command, _)| command))
        .flat_map(|line| line.split("&&"))
        .filter_map(|command| command.trim().strip_prefix("cargo run -p glint -- "));
    let commands = commands.map(words);
    commands
        .filter(|words| !words.contains(&"virtual"))
        .collect()
}

/// In each picture no colour covers more than 49 of 50 pixels, and a picture has at least six
/// colours. The lines of a wireframe have at least 1,000 pixels.
#[test]
fn every_picture_of_the_readme_shows_something() {
    let folder = folder("readme");
    let run = |arguments: &[&str]| {
        let output = glint(&folder, &[arguments, &["--quiet"]].concat());
        assert!(output.stderr.is_empty(), "{arguments:?}");
    };
    // The mesh file of the examples.
    run(&["model", "gear", "spot.obj"]);
    let page = page("README.md");
    let commands = readme(&page);
    assert!(commands.len() >= 9, "{commands:?}");
    for arguments in commands {
        run(&arguments);
        let out = value(&arguments, "--out").filter(|name| name.ends_with(".png"));
        let Some(name) = out else {
            continue;
        };
        let pixels = pixels(&folder.join(name));
        let mut counts: HashMap<&[u8], usize> = HashMap::new();
        for pixel in pixels.chunks_exact(3) {
            *counts.entry(pixel).or_default() += 1;
        }
        let (most, all) = (counts.values().max().unwrap(), pixels.len() / 3);
        let shows = match name.ends_with("wire.png") {
            true => all - most >= 1_000,
            false => most * 50 < all * 49 && counts.len() >= 6,
        };
        let colours = counts.len();
        assert!(shows, "{name}: {colours} colours, one of {most} pixels");
    }
}
