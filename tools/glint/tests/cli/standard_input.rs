//! Input files with the name `-` are read from standard input.

use crate::common::{VIEW, folder, succeed};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Runs the program with a file as its standard input.
fn glint(folder: &Path, arguments: &str, input: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_glint"))
        .args(arguments.split(' '))
        .current_dir(folder)
        .stdin(fs::File::open(folder.join(input)).unwrap())
        .output()
        .unwrap()
}

const SCENE: &str = "title = \"A box\"\nfield = \"box:1,1,1\"\ncamera = \"4 30 60\"\n";

/// Scenes, cameras, wireframe programs and logs of the motion sensor have the same effect from standard input as from a file.
#[test]
fn scenes_cameras_programs_and_recordings() {
    let folder = folder("standard-input");
    fs::write(folder.join("scene.toml"), SCENE).unwrap();
    fs::write(folder.join("view.json"), VIEW).unwrap();
    let log = "t_us,ax,ay,az,gx,gy,gz\n0,0,0,4096,0,0,9\n1000,0,0,4096,0,0,900\n";
    fs::write(folder.join("log.csv"), log).unwrap();
    for program in ["cube.wft", "cube.wfb"] {
        succeed(&folder, &format!("wireframe make cube --out {program}"));
    }
    for (file, command) in [
        ("cube.wft", "wireframe render FILE --out -"),
        ("cube.wfb", "wireframe render FILE --out -"),
        ("scene.toml", "render --scene FILE --out -"),
        ("scene.toml", "scene show FILE"),
        ("view.json", "render cube --view FILE --out -"),
        ("log.csv", "imu replay FILE --out -"),
    ] {
        let run = |name: &str| {
            let command = command.replace("FILE", name);
            let output = glint(&folder, &command, file);
            let error = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{command}: {error}");
            assert!(!output.stdout.is_empty(), "{command}");
            output.stdout
        };
        assert!(run("-") == run(file), "{command}");
    }
    let checked = glint(&folder, "scene check -", "scene.toml");
    assert_eq!(checked.stdout, b"-: valid\n");
}

/// An error in standard input names the input `-` and the line; endless input is rejected.
#[test]
fn errors_of_scenes() {
    let folder = folder("standard-input-errors");
    let error = |contents: &str| {
        fs::write(folder.join("scene.toml"), contents).unwrap();
        let output = glint(&folder, "render --scene - --out a.png", "scene.toml");
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8(output.stderr).unwrap()
    };
    let bad = error(&SCENE.replace("4 30 60", "x 30 60"));
    assert!(bad.starts_with("error: -: line 3: "), "{bad}");
    let long = error(&format!("{SCENE}{}", "# more\n".repeat(200_000)));
    assert_eq!(
        long,
        "error: -: expected at most 1048576 bytes, found more\n"
    );
    assert!(!folder.join("a.png").exists());
}
