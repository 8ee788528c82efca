//! Output files are written completely or not at all, never replace an input, and are checked
//! before the work begins.

use crate::common::{
    SQUARE, VIEW, all_refused, assert_has, failed, folder, glint, refused, rows, succeed, words,
};
use glint_texture::example::small_png;
use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::Command;

/// Runs the program with a file size limit of 512 bytes, as on a full file system.
fn when_full(folder: &Path, arguments: &str) -> String {
    let output = Command::new("sh")
        .args([
            "-c",
            "trap '' XFSZ; ulimit -f 1; exec \"$0\" \"$@\"",
            env!("CARGO_BIN_EXE_glint"),
        ])
        .args(words(arguments))
        .current_dir(folder)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1), "{arguments:?}");
    String::from_utf8(output.stderr).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let names = folder.read_dir().unwrap();
    let mut names: Vec<_> = names
        .map(|file| file.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

const LOG: &str = "t_us,ax,ay,az,gx,gy,gz\n0,0,0,4096,0,0,0\n1000,0,0,4096,0,0,0\n";

#[test]
fn a_full_file_system_leaves_no_part_of_a_file() {
    let folder = folder("full");
    fs::write(folder.join("old.png"), "before").unwrap();
    fs::write(folder.join("log.csv"), LOG).unwrap();
    let present = names(&folder);
    for (arguments, file) in [
        ("render icosphere:4 --out new.png", "new.png"),
        ("render icosphere:4 --force --out old.png", "old.png"),
        ("render cube --out /dev/null --depth a.f32", "a.f32"),
        ("render cube --out /dev/full", "/dev/full"),
        ("render cube --out /dev/null --stats /dev/full", "/dev/full"),
        ("orbit cube --out a.gif", "a.gif"),
        ("orbit cube --out /dev/full", "/dev/full"),
        ("model teapot a.glm", "a.glm"),
        ("model teapot a.obj", "a.obj"),
        ("imu replay log.csv --out /dev/full", "/dev/full"),
        ("wireframe make teapot --out a.wfb", "a.wfb"),
    ] {
        let error = when_full(&folder, arguments);
        let expected = format!("error: {file}: cannot be written: ");
        assert!(error.starts_with(&expected), "{arguments:?}: {error}");
        assert_eq!(names(&folder), present, "{arguments:?}");
    }
    assert_eq!(fs::read(folder.join("old.png")).unwrap(), b"before");
}

/// An error states its cause only once, also if the reader of a pipe ends early.
#[test]
fn a_closed_pipe_is_stated_once() {
    let folder = folder("closed-pipe");
    for command in [
        "render cube --out -",
        "orbit cube --frames 3 --out -",
        "model teapot - --to obj",
    ] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_glint"))
            .args(words(command))
            .current_dir(&folder)
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        let causes = error.matches("roken pipe").count();
        assert!(causes <= 1, "{command}: {error}");
    }
}

#[test]
fn an_input_is_never_an_output() {
    let folder = folder("inputs");
    fs::write(folder.join("m.obj"), SQUARE).unwrap();
    fs::write(folder.join("view.json"), VIEW).unwrap();
    fs::write(folder.join("spheres.json"), "[[0,0,0,0.5]]").unwrap();
    fs::write(folder.join("log.csv"), LOG).unwrap();
    fs::write(folder.join("a.wft"), "end\n").unwrap();
    fs::write(folder.join("t.png"), small_png()).unwrap();
    symlink("m.obj", folder.join("m.png")).unwrap();
    fs::hard_link(folder.join("log.csv"), folder.join("hard.csv")).unwrap();
    symlink("a.wft", folder.join("a.png")).unwrap();
    let before = names(&folder);
    let table = "
        imu replay log.csv --out log.csv → log.csv → log.csv
        imu replay log.csv --out hard.csv → hard.csv → log.csv
        imu record log.csv --sensor hard.csv --board virtual → log.csv → hard.csv
        convert m.obj m.obj → m.obj → m.obj
        texture t.png t.png → t.png → t.png
        convert m.obj ./m.obj → ./m.obj → m.obj
        render m.obj --up z --out m.png → m.png → m.obj
        render --object m.obj --out m.png → m.png → m.obj
        render cube --view view.json --out a --stats view.json → view.json → view.json
        render --field spheres:spheres.json --out a --stats spheres.json → spheres.json → spheres.json
        wireframe convert a.wft a.wft → a.wft → a.wft
        wireframe render a.wft --out a.png → a.png → a.wft
    ";
    for [command, output, input] in rows(table) {
        let error = format!("{output}: expected another file to write, found the input {input}");
        all_refused(&folder, &format!("{command}\n{error}"));
    }
    assert_eq!(names(&folder), before);
    assert_eq!(fs::read_to_string(folder.join("log.csv")).unwrap(), LOG);
}

#[test]
fn an_extension_says_what_is_written() {
    let folder = folder("extensions");
    fs::write(folder.join("log.csv"), LOG).unwrap();
    all_refused(
        &folder,
        "
        render cube --out x.jpg
            x.jpg: expected a name that ends in .png, found '.jpg'
        render cube --out x.png --depth x.jpg
            x.jpg: expected a name that ends in .f32, .bin, .raw, .png, found '.jpg'
        render cube --out x.png --stats x.csv
            x.csv: expected a name that ends in .json, found '.csv'
        imu replay log.csv --out x.json
            x.json: expected a name that ends in .csv, found '.json'
        gesture mask --board virtual --out x.gif
            x.gif: expected a name that ends in .png, found '.gif'
        ",
    );
    succeed(&folder, "render cube --out X.PNG --depth depth");
    assert_eq!(names(&folder), ["X.PNG", "depth", "log.csv"]);
}

#[test]
fn an_output_is_checked_before_the_work() {
    let folder = folder("checked");
    // The port does not exist, but this error would come later.
    for command in [
        "render cube --out gone/a.png",
        "render cube --out /dev/null --stats gone/a.json",
        "imu record gone/log.csv",
        "gesture mask --out gone/a.png",
    ] {
        let error = failed(&folder, &format!("{command} --board /dev/no-such-port"), 1);
        assert!(error.starts_with("error: gone/"), "{error}");
        assert_has(&error, ": cannot be written: ");
    }
    assert!(names(&folder).is_empty());
}

#[test]
fn a_link_stays_and_permissions_too() {
    let folder = folder("links");
    let [file, link] = ["file.glm", "link.glm"].map(|name| folder.join(name));
    fs::write(&file, "before").unwrap();
    fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
    symlink(&file, &link).unwrap();
    succeed(&folder, "model cube link.glm");
    assert!(link.is_symlink());
    assert!(fs::read(&file).unwrap().starts_with(b"GLM2"));
    assert_eq!(file.metadata().unwrap().permissions().mode() & 0o777, 0o640);
    assert_eq!(names(&folder), ["file.glm", "link.glm"]);
}

/// Every command replaces a file that is not empty only with `--force`, and checks this before any work; an empty file is
/// replaced.
#[test]
fn a_file_with_contents_is_kept() {
    let folder = folder("kept");
    fs::write(folder.join("log.csv"), LOG).unwrap();
    fs::write(folder.join("a.wft"), "end\n").unwrap();
    fs::write(folder.join("empty.png"), "").unwrap();
    let old = ["png", "glm", "csv", "wfb", "json", "gif", "glt"].map(|end| format!("old.{end}"));
    for name in &old {
        fs::write(folder.join(name), "mine").unwrap();
    }
    for (command, name) in [
        ("render cube --out old.png", "old.png"),
        ("render cube --out /dev/null --stats old.json", "old.json"),
        ("orbit cube --out old.gif", "old.gif"),
        ("model cube old.glm", "old.glm"),
        ("texture empty.png old.glt", "old.glt"),
        ("imu replay log.csv --out old.csv", "old.csv"),
        ("imu record old.csv", "old.csv"),
        ("gesture mask --out old.png", "old.png"),
        ("wireframe convert a.wft old.wfb", "old.wfb"),
        ("wireframe make cube --out old.wfb", "old.wfb"),
        ("wireframe render a.wft --out old.png", "old.png"),
        ("demo --out .", "./old.png"),
    ] {
        let expected = "expected a new file, or --force to replace it, found a file of 4 bytes";
        all_refused(&folder, &format!("{command}\n{name}: {expected}"));
    }
    for name in &old {
        assert_eq!(fs::read(folder.join(name)).unwrap(), b"mine");
    }
    for arguments in [
        "render cube --out empty.png",
        "render cube --out old.png --force",
        "render cube --out old.png -f",
    ] {
        assert!(glint(&folder, arguments).status.success());
    }
    let empty = fs::read(folder.join("empty.png")).unwrap();
    assert!(empty == fs::read(folder.join("old.png")).unwrap());
}

/// `-` reads a mesh from standard input, in every format, and writes meshes and pictures to standard output; reports go to standard error.
#[test]
fn standard_input_and_output() {
    let folder = folder("standard");
    succeed(&folder, "render icosphere:2 --quality fast --out whole.png");
    let whole = fs::read(folder.join("whole.png")).unwrap();
    let piped = glint(&folder, "render icosphere:2 --quality fast --out - --json");
    assert!(piped.status.success() && piped.stdout == whole);
    let report: serde_json::Value = serde_json::from_slice(&piped.stderr).unwrap();
    assert_eq!(report["triangles_in"], 80);
    for format in ["obj", "stl", "ply", "glm"] {
        let piped = glint(&folder, &format!("model icosphere:2 - --to {format}"));
        assert!(piped.status.success());
        fs::write(folder.join("mesh"), &piped.stdout).unwrap();
        let file = format!("file.{format}");
        succeed(&folder, &format!("model icosphere:2 {file}"));
        let named = fs::read(folder.join(&file)).unwrap();
        assert!(named == piped.stdout, "{format}");
        let run = |command: String| {
            let output = Command::new(env!("CARGO_BIN_EXE_glint"))
                .args(words(&command))
                .stdin(fs::File::open(folder.join("mesh")).unwrap())
                .current_dir(&folder)
                .output()
                .unwrap();
            let error = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{command}: {error}");
            output.stdout
        };
        for (command, more) in [
            ("render", "--up z --out -"),
            ("convert", "- --to glm"),
            ("orbit", "--up z --frames 2 --out -"),
        ] {
            let [piped, named] = ["-", &file].map(|input| run(format!("{command} {input} {more}")));
            assert!(piped == named, "{format}: {command}");
        }
    }
    let error = refused(&folder, "model cube -");
    assert_eq!(error, "error: -: expected --to with a format, found none");
    let error = refused(&folder, "render cube --out - --stats -");
    let expected = "error: -: expected one output to standard output, found two";
    assert_eq!(error, expected);
}
