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

/// The arguments of a command line; single quotes join words.
pub fn words(command: &str) -> Vec<&str> {
    let parts = command.split('\'').enumerate();
    let words = parts.flat_map(|(i, part)| match i % 2 {
        0 => part.split_whitespace().collect(),
        _ => vec![part],
    });
    words.collect()
}

/// Runs a command with 256 MiB of address space, so that unbounded memory use fails.
pub fn glint(folder: &Path, command: &str) -> Output {
    glint_in(folder, command, &[])
}

/// Runs a command with environment variables that set its configuration.
pub fn glint_in(folder: &Path, command: &str, variables: &[(&str, &str)]) -> Output {
    glint_within(256, folder, command, variables)
}

/// Runs a command with `mebibytes` MiB of address space.
pub fn glint_within(
    mebibytes: u32,
    folder: &Path,
    command: &str,
    variables: &[(&str, &str)],
) -> Output {
    let limited = format!("ulimit -v {}; exec \"$0\" \"$@\"", mebibytes << 10);
    Command::new("sh")
        .env_remove("GLINT_BOARD")
        .env_remove("GLINT_BAUD")
        .env("XDG_CONFIG_HOME", folder)
        .envs(variables.iter().copied())
        .args(["-c", &limited, env!("CARGO_BIN_EXE_glint")])
        .args(words(command))
        .current_dir(folder)
        .output()
        .unwrap()
}

/// Runs a command without additional arguments, and returns its standard output and standard error.
pub fn said(folder: &Path, command: &str) -> [String; 2] {
    let output = glint(folder, command);
    let [out, error] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
    assert!(output.status.success(), "{command}: {error}");
    [out, error]
}

/// Runs a command with `--force`, which must succeed, and returns its standard output.
pub fn succeed(folder: &Path, command: &str) -> String {
    let [out, _] = said(folder, &format!("{command} --force"));
    out
}

/// Runs a command with `--json`, and returns its report.
pub fn report(folder: &Path, command: &str) -> serde_json::Value {
    serde_json::from_str(&succeed(folder, &format!("{command} --json"))).unwrap()
}

/// Runs a command that writes a picture, and returns the picture.
pub fn drawn(folder: &Path, command: &str) -> Vec<u8> {
    succeed(folder, &format!("{command} --out a.png"));
    picture(&folder.join("a.png"))
}

/// Checks that a text contains another text.
#[track_caller]
pub fn assert_has(text: &str, part: &str) {
    assert!(text.contains(part), "{text}");
}

/// Runs a command that must fail with this exit code; returns its standard error.
pub fn failed(folder: &Path, command: &str, code: i32) -> String {
    let output = glint(folder, command);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{command}: {error}");
    assert!(output.stdout.is_empty(), "{command}");
    error
}

/// Runs a command on input that it must reject; returns its error, which has one line.
pub fn refused(folder: &Path, command: &str) -> String {
    let error = failed(folder, command, 2);
    assert_eq!(error.lines().count(), 1, "{command}: {error}");
    assert_has(&error, "expected ");
    assert_has(&error, "found ");
    error.trim_end().to_owned()
}

/// The rows of a table; `→` separates the `N` cells of a row.
pub fn rows<const N: usize>(table: &str) -> impl Iterator<Item = [&str; N]> {
    let rows = table.lines().filter(|row| !row.trim().is_empty());
    rows.map(|row| {
        let cells: Vec<_> = row.split('→').map(str::trim).collect();
        cells.try_into().unwrap_or_else(|_| panic!("{row}"))
    })
}

/// Runs commands that must be rejected. Each command is a line, and its error is the next line; `…` stands for any text at the
/// end of the error.
pub fn all_refused(folder: &Path, cases: &str) {
    let lines: Vec<&str> = cases.lines().map(str::trim).collect();
    let lines: Vec<&str> = lines.into_iter().filter(|line| !line.is_empty()).collect();
    for [command, expected] in lines.as_chunks().0 {
        let error = refused(folder, command);
        let error = error.strip_prefix("error: ").unwrap();
        match expected.strip_suffix('…') {
            Some(start) => assert!(error.starts_with(start), "{command}: {error}"),
            None => assert_eq!(error, *expected, "{command}"),
        }
    }
}

/// Writes files that each command must reject. `FILE` in a command stands for the name of the file;
/// `errors` has a line for each file, as in [`all_refused`].
pub fn files_refused<const N: usize>(
    folder: &Path,
    commands: [&str; N],
    files: &[(&str, Vec<u8>)],
    errors: &str,
) {
    let errors: Vec<_> = errors.lines().map(str::trim).collect();
    let errors: Vec<_> = errors.iter().filter(|line| !line.is_empty()).collect();
    assert_eq!(errors.len(), files.len());
    for ((name, contents), error) in files.iter().zip(errors) {
        std::fs::write(folder.join(name), contents).unwrap();
        for command in commands {
            all_refused(
                folder,
                &format!("{}\n{error}", command.replace("FILE", name)),
            );
        }
    }
}

pub const VIEW: &str =
    r#"{"eye":[0,-2,0],"u":[1,0,0],"v":[0,0,-1],"n":[0,1,0],"half_width":0.9,"near":0.1}"#;

/// Reads the RGB pixels of a picture, whose aspect ratio must be 16:9.
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
