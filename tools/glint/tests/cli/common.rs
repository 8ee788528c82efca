//! Runs the program `glint`, and reads its output files.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// An empty folder for a test.
pub fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("cli")
        .join(name);
    if path.exists() {
        std::fs::remove_dir_all(&path).unwrap();
    }
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// Runs the program with 256 MiB of address space, so that unbounded use of memory fails.
pub fn glint(folder: &Path, arguments: &[&str]) -> Output {
    glint_in(folder, arguments, &[])
}

/// Runs the program with variables of the environment in which it finds its settings.
pub fn glint_in(folder: &Path, arguments: &[&str], variables: &[(&str, &str)]) -> Output {
    glint_within(256, folder, arguments, variables)
}

/// Runs the program with this many MiB of address space.
pub fn glint_within(
    mebibytes: u32,
    folder: &Path,
    arguments: &[&str],
    variables: &[(&str, &str)],
) -> Output {
    let limited = format!("ulimit -v {}; exec \"$0\" \"$@\"", mebibytes << 10);
    Command::new("sh")
        .env_remove("GLINT_BOARD")
        .env_remove("GLINT_BAUD")
        .env("XDG_CONFIG_HOME", folder)
        .envs(variables.iter().copied())
        .args(["-c", &limited, env!("CARGO_BIN_EXE_glint")])
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

/// Runs the program, which replaces what it has written before, and returns what it prints.
pub fn succeed(folder: &Path, arguments: &[&str]) -> String {
    let output = glint(folder, &[arguments, &["--force"]].concat());
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {error}");
    String::from_utf8(output.stdout).unwrap()
}

/// Runs the program on input that it must reject; returns its single line of error.
pub fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = glint(folder, arguments);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
    assert_eq!(error.lines().count(), 1, "{arguments:?}: {error}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    assert!(
        error.contains("expected ") && error.contains("found "),
        "{arguments:?}: {error}"
    );
    error.trim_end().to_owned()
}

pub const VIEW: &str =
    r#"{"eye":[0,-2,0],"u":[1,0,0],"v":[0,0,-1],"n":[0,1,0],"half_width":0.9,"near":0.1}"#;

/// Reads the RGB pixels of a picture, whose sides must be 16:9.
pub fn picture(path: &Path) -> Vec<u8> {
    let decoder = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!(
        (info.width * 9, info.color_type),
        (info.height * 16, png::ColorType::Rgb)
    );
    pixels
}

pub fn depths(path: &Path) -> Vec<f32> {
    let number = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().unwrap());
    let bytes = std::fs::read(path).unwrap();
    bytes.chunks_exact(4).map(number).collect()
}

pub fn json(path: &Path) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

pub const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
