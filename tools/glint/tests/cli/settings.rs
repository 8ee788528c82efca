//! Defaults from the environment and from the configuration file, ports, and the amount of output.

use crate::common::{
    all_refused, assert_has, failed, files_refused, folder, glint, glint_in, report, said, succeed,
    words,
};
use std::path::Path;
use std::process::Command;

/// Runs a command that must fail, and returns its error, which has one line.
fn error(folder: &Path, arguments: &str, variables: &[(&str, &str)]) -> String {
    let output = glint_in(folder, arguments, variables);
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(!output.status.success(), "{error}");
    assert_eq!(error.lines().count(), 1, "{error}");
    error
}

#[test]
fn an_option_goes_before_the_environment_and_that_before_the_file() {
    let folder = folder("settings");
    std::fs::create_dir(folder.join("glint")).unwrap();
    let file = folder.join("glint/config.toml");
    std::fs::write(&file, "board = \"/dev/of-the-file\"\nbaud = 9600\n").unwrap();
    let variable = [("GLINT_BOARD", "/dev/of-the-environment")];
    let [upload, option] = ["upload cube", "upload cube --board /dev/of-the-option"];
    for (command, variables, expected) in [
        (upload, &[][..], "file"),
        (upload, &variable, "environment"),
        (option, &variable, "option"),
        ("console --send info", &[], "file"),
        ("info", &variable, "environment"),
        ("imu calibrate", &[], "file"),
        ("gesture mask --out x.png", &[], "file"),
        // An empty variable counts as unset.
        (upload, &[("GLINT_BOARD", "")], "file"),
    ] {
        let error = error(&folder, command, variables);
        let expected = format!("/dev/of-the-{expected}");
        let start =
            format!("error: {expected}: expected `emulated`, `virtual` or a serial port, found: ");
        assert!(error.starts_with(&start), "{error}");
        // The error lists the ports of this host, if any.
        assert!(error.contains("; this host has "), "{error}");
    }
    let slow = error(&folder, upload, &[("GLINT_BAUD", "slow")]);
    assert_eq!(
        slow,
        "error: GLINT_BAUD: expected a number of bits per second from 50 to 12000000, found 'slow'\n"
    );
    std::fs::write(&file, "bord = \"x\"\n").unwrap();
    let damaged = error(&folder, upload, &[]);
    let start = format!("error: {}: expected board = \"NAME\"", file.display());
    assert!(damaged.starts_with(&start), "{damaged}");
    std::fs::remove_file(&file).unwrap();
    std::os::unix::fs::symlink("/dev/zero", &file).unwrap();
    let end = "expected a file, found a folder, a pipe or a device\n";
    let device = error(&folder, upload, &[]);
    assert!(device.ends_with(end), "{device}");
    std::fs::remove_file(&file).unwrap();
    let made = Command::new("mkfifo").arg(&file).status();
    assert!(made.unwrap().success());
    let pipe = error(&folder, upload, &[]);
    assert!(pipe.ends_with(end), "{pipe}");
    // Commands that use no board do not read the file.
    succeed(&folder, "model cube cube.obj");
}

/// Only on a terminal do the labels of errors and warnings have the colours of clap's labels. A
/// standard error that accepts no output does not change the exit code.
#[test]
fn colours() {
    let folder = folder("colours");
    let missing = "render missing.obj --out a.png";
    let inside = "render --field box:3,3,3 --camera 3,30,60 --out a.png";
    for (arguments, label) in [
        (missing, "\x1b[1m\x1b[31merror:\x1b[0m missing.obj: "),
        ("render", "\x1b[1m\x1b[31merror:\x1b[0m the following"),
        (inside, "\x1b[1m\x1b[33mwarning:\x1b[0m the eye "),
    ] {
        let said = |variables: &[(&str, &str)]| {
            let arguments = format!("{arguments} --force");
            String::from_utf8(glint_in(&folder, &arguments, variables).stderr).unwrap()
        };
        let forced = said(&[("CLICOLOR_FORCE", "1"), ("NO_COLOR", "")]);
        assert!(forced.contains(label), "{forced:?}");
        assert!(!said(&[]).contains('\x1b'));
    }
    let full = [
        "-c",
        "exec \"$0\" \"$@\" 2>/dev/full",
        env!("CARGO_BIN_EXE_glint"),
    ];
    let mut command = std::process::Command::new("sh");
    let command = command.args(full).args(words(missing)).current_dir(&folder);
    assert_eq!(command.status().unwrap().code(), Some(2));
}

/// Options that do not apply to the chosen board are rejected.
#[test]
fn options_of_another_board() {
    let folder = folder("useless-options");
    let log = "t_us,ax,ay,az,gx,gy,gz\n0,0,0,4096,0,0,0\n";
    std::fs::write(folder.join("log.csv"), log).unwrap();
    std::fs::write(folder.join("a.wft"), "end\n").unwrap();
    let drawing = [
        "render cube --out a.png",
        "render --scene cubes --out a.png",
        "orbit cube --out a.gif",
        "wireframe render a.wft --out a.png",
    ];
    let replay = "imu replay log.csv --out b.csv";
    let of_the_line = ["--transfer serial", "--baud 9600", "--firmware x.bin"];
    let of_a_board = ["--backend cpu"].into_iter().chain(of_the_line);
    let by_the_model = drawing
        .into_iter()
        .flat_map(|command| of_a_board.clone().map(move |option| (command, option)))
        .chain(of_the_line.map(|option| (replay, option)));
    let port = "a serial port";
    let by_a_board = [
        ("console emulated --send info", "--baud 9600", port),
        ("info", "--baud 9600", port),
        ("board --board virtual", "--baud 9600", port),
        ("flash log.csv --board virtual", "--baud 9600", port),
    ];
    let by_the_model = by_the_model.map(|(command, option)| (command, option, "a board"));
    for (command, option, expected) in by_the_model.chain(by_a_board) {
        let name = words(option)[0];
        let error = format!("{name}: expected {expected}, found --board …");
        all_refused(&folder, &format!("{command} {option}\n{error}"));
    }
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 2);
}

#[test]
fn ports_are_listed() {
    let folder = folder("ports");
    let ports = report(&folder, "ports");
    let lines = succeed(&folder, "ports");
    // Without any port the command prints one line, too.
    let expected = ports.as_array().unwrap().len().max(1);
    assert_eq!(lines.lines().count(), expected);
}

/// Warnings are printed by default, `--quiet` omits them, and `--verbose` adds the steps with their times.
#[test]
fn quiet_and_verbose() {
    let folder = folder("loudness");
    let said = |more: &str| {
        let render = "render cube --look-at 0,-2,0,0,-1,0 --out";
        said(&folder, &format!("{render} {more}"))[1].clone()
    };
    let usual = said("a.png");
    let start = "warning: no triangle is drawn: ";
    assert!(usual.starts_with(start), "{usual}");
    assert_eq!(usual.lines().count(), 1);
    assert_eq!(said("b.png --quiet"), "");
    assert_eq!(said("c.png -q"), "");
    let verbose = said("d.png -v");
    let step = verbose.lines().find(|line| line.starts_with("rendering: "));
    let seconds = step.unwrap().strip_prefix("rendering: ").unwrap();
    assert!(seconds.strip_suffix(" s").unwrap().parse::<f64>().is_ok());
    assert!(verbose.contains(&usual));
}

/// The program and each command have a manual page, which names the command's options.
#[test]
fn manual_pages() {
    let folder = folder("man");
    succeed(&folder, "man pages/man1");
    let page = |name: &str| {
        let text = std::fs::read_to_string(folder.join("pages/man1").join(name)).unwrap();
        assert!(text.contains(".TH"), "{name}");
        // roff writes a backslash before each hyphen.
        text.replace('\\', "")
    };
    assert!(page("glint.1").contains("glint-render(1)"));
    assert!(page("glint-render.1").contains("--aa"));
    assert!(page("glint-imu-replay.1").contains("--follow-bias"));
    // Manual pages follow the rules for output files.
    let again = glint(&folder, "man pages/man1");
    let error = String::from_utf8(again.stderr).unwrap();
    assert_has(&error, "or --force to replace it");
}

#[test]
fn a_cause_is_printed_once() {
    let folder = folder("settings-cause");
    for command in ["info --board /dev/ttyUSB9", "console ./none --send info"] {
        let error = failed(&folder, command, 1);
        assert_eq!(error.matches("No such file").count(), 1, "{error}");
    }
}

#[test]
fn a_baud_rate_is_one_of_a_serial_line() {
    let folder = folder("settings-baud");
    let expected = "expected a number of bits per second from 50 to 12000000, found";
    for value in ["0", "4294967295", "fast"] {
        let variables = [("GLINT_BAUD", value), ("GLINT_BOARD", "/dev/ttyUSB9")];
        let output = glint_in(&folder, "info", &variables);
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{value}: {error}");
        assert_eq!(error, format!("error: GLINT_BAUD: {expected} '{value}'\n"));
    }
    all_refused(
        &folder,
        &format!("info --board /dev/ttyUSB9 --baud 0\n--baud: {expected} '0'"),
    );
    std::fs::create_dir_all(folder.join("glint")).unwrap();
    std::fs::write(folder.join("glint/config.toml"), "baud = 0\n").unwrap();
    all_refused(
        &folder,
        &format!("info --board /dev/ttyUSB9\nthe configuration file's baud: {expected} '0'"),
    );
}

/// A script from an endless device is rejected within bounded memory. The lines of a pipe are
/// executed as they arrive.
#[test]
fn scripts_of_devices_and_pipes() {
    let folder = folder("settings-scripts");
    let error = failed(&folder, "console emulated --file /dev/zero", 1);
    assert_has(
        &error,
        "expected lines of at most 65536 bytes, found a longer one",
    );
    let pipe = folder.join("pipe");
    let made = Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    let writer = std::thread::spawn(move || std::fs::write(pipe, "echo one\necho two\n"));
    let replies = succeed(&folder, "console emulated --file pipe");
    assert_eq!(replies, "one\ntwo\n");
    writer.join().unwrap().unwrap();
}

/// The help of `render` and `orbit` groups the options. Only options that all commands have are
/// outside of the groups.
#[test]
fn the_help_has_groups() {
    let folder = folder("settings-help");
    for command in ["render", "orbit"] {
        let [help, _] = said(&folder, &format!("{command} --help"));
        let mut group = "";
        let mut options = Vec::new();
        for line in help.lines() {
            match line.strip_suffix(':') {
                Some(heading) if !line.starts_with(' ') => group = heading,
                _ if line.trim_start().starts_with('-') => {
                    let mut words = line.split_whitespace();
                    let option = words.find_map(|word| word.strip_prefix("--"));
                    options.extend(option.map(|option| (group, option)));
                }
                _ => {}
            }
        }
        for expected in [
            ("Subject", "scene"),
            ("Subject", "field"),
            ("Camera", "camera"),
            ("Camera", "fov"),
            ("Camera", "up"),
            ("Appearance", "shading"),
            ("Picture", "size"),
            ("Picture", "out"),
            ("Picture", "aa"),
            ("Renderer", "board"),
            ("Renderer", "baud"),
        ] {
            let has = options.contains(&expected);
            assert!(has, "{command} {expected:?}: {options:?}");
        }
        let common = options.iter().filter(|(group, _)| *group == "Options");
        let common: Vec<_> = common.map(|(_, option)| *option).collect();
        assert_eq!(common, ["quiet", "verbose", "force", "help"], "{command}");
    }
}

/// A program file that a board cannot run is rejected before the board is opened.
#[test]
fn only_programs_are_flashed() {
    let folder = folder("settings-programs");
    let flat = "expected a flat binary that begins with an RV32IM instruction";
    files_refused(
        &folder,
        [
            "flash FILE --board emulated",
            "board --firmware FILE",
            "info --board emulated --firmware FILE",
            "image make --out a.bin --firmware FILE",
        ],
        &[
            ("glint.elf", b"\x7fELF\x01\x01\x01\0".to_vec()),
            ("notes.txt", b"read me\n".to_vec()),
            ("zeros.bin", vec![0; 100]),
            ("/dev/null", vec![]),
        ],
        &format!(
            "
            glint.elf: expected a program for Glint's boards, found an ELF file that is damaged, or not for a 32-bit processor: Invalid ELF header size or alignment
            notes.txt: {flat}, found the text 'read'
            zeros.bin: {flat}, found the bytes [00, 00, 00, 00]
            /dev/null: {flat}, found a file of 0 bytes
            "
        ),
    );
}
