//! The commands in docs/gallery.md produce its pictures, and every field has a picture.

use std::path::{Path, PathBuf};
use std::process::Command;

use glint_core::field::KINDS;

/// Maximum total size of all pictures in bytes.
const MOST: u64 = 400_000;

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}

/// Arguments of each `glint …` command in docs/gallery.md, where a `\` continues a line.
fn commands() -> Vec<Vec<String>> {
    let page = std::fs::read_to_string(docs().join("gallery.md")).expect("the page");
    let page = page.replace("\\\n", " ");
    let commands = page.lines().filter_map(|line| line.strip_prefix("glint "));
    commands
        .map(|line| line.split_whitespace().map(str::to_owned).collect())
        .collect()
}

/// The value of `option` in a command.
fn value<'a>(command: &'a [String], option: &str) -> &'a str {
    let at = command.iter().position(|word| word == option);
    let value = at.and_then(|at| command.get(at + 1));
    value.unwrap_or_else(|| panic!("no {option} in {command:?}"))
}

fn pixels(path: &Path) -> Vec<u8> {
    let file = std::fs::File::open(path).unwrap_or_else(|error| panic!("{path:?}: {error}"));
    let mut reader = png::Decoder::new(std::io::BufReader::new(file))
        .read_info()
        .expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    reader.next_frame(&mut pixels).expect("a picture");
    pixels
}

/// Renders every picture and compares it with the committed picture; with the environment variable `GLINT_UPDATE`, replaces the
/// committed picture.
#[test]
fn the_commands_produce_their_pictures() {
    let update = std::env::var_os("GLINT_UPDATE").is_some();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("gallery");
    std::fs::create_dir_all(&folder).expect("the build's own folder");
    let root = docs().join("..");
    let mut bytes = 0;
    for command in commands() {
        let shown = root.join(value(&command, "--out"));
        let made = if update {
            shown.clone()
        } else {
            folder.join("made.png")
        };
        let stats = folder.join("stats.json");
        let output = Command::new(env!("CARGO_BIN_EXE_glint"))
            .arg("--force")
            .args(command.iter().map(|word| {
                if word == value(&command, "--out") {
                    made.as_os_str()
                } else {
                    word.as_ref()
                }
            }))
            .arg("--stats")
            .arg(&stats)
            .current_dir(&root)
            .output()
            .expect("the program runs");
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{command:?}: {error}");
        let stats = std::fs::read(&stats).expect("the counts");
        let stats: serde_json::Value = serde_json::from_slice(&stats).expect("JSON");
        // Only the picture of a field has rays.
        assert!(
            matches!(stats["undecided"].as_u64(), None | Some(0)),
            "{command:?}: undecided rays are visible"
        );
        assert!(
            pixels(&made) == pixels(&shown),
            "{}: `GLINT_UPDATE=1 cargo test -p glint --test gallery` replaces the picture",
            shown.display()
        );
        bytes += std::fs::metadata(&shown).expect("a file").len();
    }
    assert!(bytes < MOST, "{bytes} bytes of pictures");
}

#[test]
fn every_field_has_a_picture() {
    let mut commands = commands();
    commands.retain(|command| command.iter().any(|word| word == "--field"));
    for (form, _) in KINDS {
        let kind = form.split(':').next().unwrap_or(form);
        let shows =
            |command: &Vec<String>| value(command, "--field").split(':').next() == Some(kind);
        assert!(
            commands.iter().any(shows),
            "docs/gallery.md has no picture of {kind}"
        );
    }
}
