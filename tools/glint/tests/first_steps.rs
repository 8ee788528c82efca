//! Runs the commands of docs/first-steps.md in order, and compares their pictures with those of the page. Requires the build of
//! `cargo xtask firmware`.

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Commands of the page that are not run here: other tests cover them.
const BUILDS: [&str; 2] = ["cargo install --path tools/glint", "cargo xtask firmware"];

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}

/// The lines of each code block in the given language.
fn blocks<'a>(page: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    let blocks = page.split(&fence).skip(1);
    blocks
        .filter_map(|rest| Some(rest.split_once("```")?.0))
        .collect()
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

/// With the environment variable `GLINT_UPDATE`, replaces the pictures.
#[test]
fn the_commands_make_the_pictures() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("first-steps");
    std::fs::create_dir_all(&folder).unwrap();
    let page = std::fs::read_to_string(docs().join("first-steps.md")).unwrap();
    let [house] = blocks(&page, "obj")[..] else {
        panic!("one model");
    };
    std::fs::write(folder.join("house.obj"), house).unwrap();
    let commands: Vec<&str> = blocks(&page, "sh")
        .into_iter()
        .flat_map(str::lines)
        .collect();
    let mut made = Vec::new();
    for command in &commands {
        let Some(arguments) = command.strip_prefix("glint ") else {
            assert!(BUILDS.contains(command), "{command}");
            continue;
        };
        let arguments = words(arguments);
        let output = Command::new(env!("CARGO_BIN_EXE_glint"))
            .args(&arguments)
            .arg("--force")
            .current_dir(&folder)
            .output()
            .unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{command}: {error}");
        assert!(!output.stdout.is_empty(), "{command}");
        let mut lines = error.lines();
        assert!(
            lines.all(|line| line.starts_with("note: ")),
            "{command}: {error}"
        );
        let out = arguments.iter().position(|word| *word == "--out");
        made.extend(out.and_then(|at| arguments.get(at + 1)).copied());
    }
    assert_eq!(made.len(), 6, "{commands:?}");
    let mut bytes = 0;
    for name in made {
        let shown = format!("pictures/first-{name}");
        assert!(page.contains(&format!("]({shown})")), "{shown}");
        let (made, shown) = (folder.join(name), docs().join(shown));
        if std::env::var_os("GLINT_UPDATE").is_some() {
            std::fs::copy(&made, &shown).unwrap();
        }
        assert!(
            pixels(&made) == pixels(&shown),
            "{shown:?}: `GLINT_UPDATE=1 cargo test -p glint --test first_steps` replaces the pictures"
        );
        bytes += std::fs::metadata(&shown).unwrap().len();
    }
    assert!(bytes < 400_000, "{bytes} bytes of pictures");
}
