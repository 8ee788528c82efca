//! Runs the commands of README.md that require no board, and checks that their pictures are not empty.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Arguments of each `glint` command of the section "Models and fields" that runs without a board.
fn commands() -> Vec<Vec<String>> {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../README.md");
    let page = std::fs::read_to_string(page).unwrap();
    let (_, section) = page.split_once("## Models and fields").unwrap();
    let (section, _) = section.split_once("\n## ").unwrap();
    let commands = section
        .lines()
        .filter(|line| line.starts_with("cargo run -p glint"));
    let commands = commands
        .map(|line| line.split_once('#').map_or(line, |(command, _)| command))
        .flat_map(|line| line.split("&&"))
        .filter_map(|command| command.trim().strip_prefix("cargo run -p glint -- "))
        .map(|command| command.split_whitespace().map(str::to_owned).collect())
        .filter(|words: &Vec<String>| !words.iter().any(|word| word == "virtual"));
    commands.collect()
}

/// Checks that no colour takes more than 49/50 of a picture's pixels, and that the picture has at least six colours. A wireframe
/// must have white lines of at least 1,000 pixels.
fn check_picture(path: &Path) {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    let mut counts: HashMap<&[u8], usize> = HashMap::new();
    for pixel in pixels.chunks_exact(3) {
        *counts.entry(pixel).or_default() += 1;
    }
    let most = counts.values().max().unwrap();
    let all = pixels.len() / 3;
    let shows = match path.ends_with("wire.png") {
        true => all - most >= 1_000,
        false => most * 50 < all * 49 && counts.len() >= 6,
    };
    assert!(
        shows,
        "{path:?}: {} colours, one of {most} pixels",
        counts.len()
    );
}

#[test]
fn every_picture_shows_something() {
    let folder: PathBuf = Path::new(env!("CARGO_TARGET_TMPDIR")).join("readme");
    std::fs::create_dir_all(&folder).unwrap();
    let glint = |arguments: &[String]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_glint"));
        let output = command
            .args(arguments)
            .args(["--force", "--quiet"])
            .current_dir(&folder)
            .output()
            .unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{arguments:?}: {error}");
        assert!(error.is_empty(), "{arguments:?}: {error}");
    };
    // The mesh file of the examples.
    glint(&["model", "gear", "spot.obj"].map(str::to_owned));
    let commands = commands();
    assert!(commands.len() >= 9, "{commands:?}");
    for arguments in commands {
        glint(&arguments);
        if let Some(at) = arguments.iter().position(|word| word == "--out")
            && let Some(file) = arguments.get(at + 1).filter(|name| name.ends_with(".png"))
        {
            check_picture(&folder.join(file));
        }
    }
}
