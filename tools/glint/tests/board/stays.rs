//! A board that keeps running, and programs that use it one after another.

use crate::common::{assert_has, begin_upload, mesh, piped};
use crate::serial_boot::{MUTE, printer};
use crate::terminal::{Terminal, patience};
use glint::board::Uart;
use glint::board::{self, Board as _, SerialBoard};
use glint::console::Console;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use virtual_board::pty::Pty;

/// Seconds without output after which litex_term counts as failed.
const PATIENCE: u32 = 120;

/// `glint board` in its own process, with an emulated board.
struct Stay {
    child: Child,
    folder: PathBuf,
}

impl Stay {
    fn start() -> Self {
        Self::start_with("board-stays", &[])
    }

    /// Starts the board in a folder with this name, with additional arguments.
    fn start_with(folder: &str, arguments: &[&str]) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder);
        std::fs::create_dir_all(&folder).unwrap();
        let mut child = Command::new(env!("CARGO_BIN_EXE_glint"))
            .args(["board", "--pty", "port", "--ready-file", "ready"])
            .args(arguments)
            .current_dir(&folder)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let port = lines.next().unwrap().unwrap();
        let target = std::fs::read_link(folder.join("port"));
        assert_eq!(target.unwrap(), Path::new(&port));
        Self { child, folder }
    }

    fn glint(&self, arguments: &str, input: &str) -> Output {
        let mut glint = Command::new(env!("CARGO_BIN_EXE_glint"));
        let arguments = arguments
            .split('\'')
            .enumerate()
            .flat_map(|(i, part)| match i % 2 {
                0 => part.split_whitespace().collect(),
                _ => vec![part],
            });
        piped(glint.args(arguments).current_dir(&self.folder), input)
    }

    fn succeed(&self, arguments: &str, input: &str) -> String {
        let output = self.glint(arguments, input);
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{arguments}: {error}");
        String::from_utf8(output.stdout).unwrap()
    }
}

impl Drop for Stay {
    fn drop(&mut self) {
        // An error means that the program has already ended, as it does unless the test failed.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Begins an upload, and closes the port in the middle of it. Before that, checks that no other
/// program can use the port.
fn upload_a_part(stay: &Stay, port: &Path, mesh: &[u8]) {
    let mut board = SerialBoard::open(port.to_str().unwrap(), 115_200).unwrap();
    let mut console = Console::new(&mut board);
    console.synchronise().unwrap();
    let other = stay.glint("info --board port", "");
    assert_eq!(other.status.code(), Some(1));
    let error = String::from_utf8(other.stderr).unwrap();
    let expected =
        "error: port: expected a serial port that no other program uses, found one in use";
    assert!(error.starts_with(expected), "{error}");
    begin_upload(&mut console, mesh);
}

#[test]
fn programs_use_one_board_in_turn() {
    let mut stay = Stay::start();
    let port = stay.folder.join("port");
    let upload = "upload icosphere:1 --board port --json";
    let report: serde_json::Value = serde_json::from_str(&stay.succeed(upload, "")).unwrap();
    assert_eq!(report["bytes"], mesh("icosphere:1").len());

    upload_a_part(&stay, &port, &mesh("icosphere:4"));
    let script = "# the model\n\ninfo triangles\n";
    std::fs::write(stay.folder.join("script"), script).unwrap();
    let reply = stay.succeed("console port --file script", "");
    assert_eq!(reply, "triangles 20\n");
    upload_a_part(&stay, &port, &mesh("icosphere:4"));
    stay.succeed("upload icosphere:4 --board port", "");
    let pipe = stay.succeed("console port", "info triangles\n");
    assert_eq!(pipe, "triangles 320\n");
    let info = stay.succeed("info --board port --json", "");
    let info: serde_json::Value = serde_json::from_str(&info).unwrap();
    assert_eq!(info["triangles"], "320");

    // The log contains all output of the board. The session ends with the text of `--until` or
    // after the time-out.
    let log = stay.folder.join("log");
    if log.exists() {
        std::fs::remove_file(&log).unwrap();
    }
    let until = "console port --send 'leds 5' --until 'glint> ' --log log";
    let said = stay.succeed(until, "");
    let log = std::fs::read_to_string(&log).unwrap();
    assert!(log.ends_with(&said), "{log:?}");
    assert_has(&log, "leds 5\r\n");
    assert_has(&log, "glint> ");
    let output = stay.glint("console port --send info --until never --timeout 1", "");
    assert_eq!(output.status.code(), Some(1));
    let error = String::from_utf8(output.stderr).unwrap();
    assert_has(&error, "error: --until: expected 'never' in time, found '");

    let litex_term = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../.venv/bin/litex_term");
    let mut terminal = Terminal::start(&litex_term, &[port.to_str().unwrap()]);
    let mut is_over = patience(PATIENCE);
    terminal.type_in(b"info triangles\r");
    terminal.wait_for("triangles 320", &mut is_over);
    terminal.wait_for("ok", &mut is_over);
    terminal.type_in(b"\x03");
    terminal.wait_for("^C", &mut is_over);
    terminal.type_in(b"\x03");
    assert!(terminal.child.wait().unwrap().success());

    stay.succeed("console port --send info", "");
    let pid = stay.child.id().to_string();
    assert!(Command::new("kill").arg(pid).status().unwrap().success());
    assert!(stay.child.wait().unwrap().success());
    assert!(!port.is_symlink() && !stay.folder.join("ready").exists());
}

/// `--pty` replaces only links to pseudo-terminals. At the end it removes only its own link.
#[test]
fn only_links_to_pseudo_terminals_are_replaced() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("board-links");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(folder.join("folder")).unwrap();
    std::fs::write(folder.join("file"), "mine\n").unwrap();
    for (link, target) in [
        ("to-file", "file"),
        ("dangling", "none"),
        ("to-null", "/dev/null"),
    ] {
        std::os::unix::fs::symlink(target, folder.join(link)).unwrap();
    }
    for (name, found) in [
        ("file", "a file"),
        ("folder", "a folder"),
        ("to-file", "a link to file"),
        ("dangling", "a link to none"),
        ("to-null", "a link to /dev/null"),
    ] {
        let output = Command::new(env!("CARGO_BIN_EXE_glint"))
            .args(["board", "--pty", name, "--ready-file", "ready"])
            .current_dir(&folder)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2), "{name}");
        let expected = format!(
            "error: {name}: expected a new name, or a link to a pseudo-terminal, found {found}\n"
        );
        assert_eq!(String::from_utf8(output.stderr).unwrap(), expected);
        assert!(folder.join(name).symlink_metadata().is_ok() && !folder.join("ready").exists());
    }
    let file = std::fs::read_to_string(folder.join("to-file"));
    assert_eq!(file.unwrap(), "mine\n");
    // A killed board leaves its link behind.
    let folder = folder.join("folder");
    std::os::unix::fs::symlink("/dev/pts/999999", folder.join("port")).unwrap();
    let mut stay = Stay::start_with("board-links/folder", &[]);
    let other = Path::new("/dev/pts/999998");
    std::fs::remove_file(folder.join("port")).unwrap();
    std::os::unix::fs::symlink(other, folder.join("port")).unwrap();
    end_by("INT", &mut stay.child);
    assert_eq!(std::fs::read_link(folder.join("port")).unwrap(), other);
}

#[test]
fn a_board_that_runs_for_a_time_refuses_other_boards_and_times() {
    for (arguments, error) in [
        (
            &["--seconds", "1", "--board", "/dev/ttyUSB9"][..],
            "--board with --seconds: expected emulated or virtual, found '/dev/ttyUSB9'",
        ),
        (&["--seconds=-1"], "expected a number from 0 to 86400"),
        (&["--seconds", "nan"], "expected a number from 0 to 86400"),
        (&["--seconds", "1", "--hold", "4"], "4 is not in 0..4"),
        (
            &["--picture", "a.png"],
            "required arguments were not provided",
        ),
        (
            &["--seconds", "0", "--picture", "a.png"],
            "expected a picture on the monitor within the time",
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let mut glint = Command::new(env!("CARGO_BIN_EXE_glint"));
        glint.arg("board").args(arguments).current_dir(&folder);
        let output = piped(&mut glint, "");
        assert!(!output.status.success(), "{arguments:?}");
        let found = String::from_utf8_lossy(&output.stderr);
        assert!(found.contains(error), "{arguments:?}: {found}");
    }
}

/// An endless firmware file is rejected within bounded memory, and a signal ends the wait for a
/// pipe.
#[test]
fn firmware_of_devices_and_pipes() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("board-pipes");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    for [command, option] in [
        ["board", "--firmware"],
        ["flash", "--board=emulated"],
        ["board", "--flash"],
    ] {
        let limited = "ulimit -v 800000; exec \"$0\" \"$@\"";
        let output = Command::new("sh")
            .args(["-c", limited, env!("CARGO_BIN_EXE_glint")])
            .args([command, option, "/dev/zero"])
            .output()
            .unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{error}");
        assert_has(&error, "error: /dev/zero: expected at most ");
    }
    let made = Command::new("mkfifo").arg(folder.join("pipe")).status();
    assert!(made.unwrap().success());
    for option in ["--firmware", "--flash"] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_glint"))
            .args(["board", "--pty", "port", option, "pipe"])
            .current_dir(&folder)
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(500));
        assert!(child.try_wait().unwrap().is_none());
        end_by("TERM", &mut child);
    }
}

/// Makes an image with the built firmware.
fn make_image(contents: &[&str], image: &str) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let made = Command::new(env!("CARGO_BIN_EXE_glint"))
        .args(["image", "make", "--force", "--out", image, "--firmware"])
        .arg(root.join("target/firmware/glint.bin"))
        .args(contents)
        .status();
    assert!(made.unwrap().success());
}

#[test]
fn a_board_starts_from_an_image() {
    let image = Path::new(env!("CARGO_TARGET_TMPDIR")).join("start.bin");
    let image = image.to_str().unwrap();
    make_image(&["--scene", "demo"], image);
    let stay = Stay::start_with("board-of-an-image", &["--flash", image]);
    // A command that is sent before the firmware runs is lost, and repeated. The demo may already
    // show another of its scenes.
    let scenes = stay.succeed("console port --send scene", "");
    assert_has(&scenes, "scene start flash\n");
}

/// The step `the board starts` ends at the prompt of the BIOS, or of the firmware from the flash, and shows the board's cycles.
#[test]
fn the_start_with_the_bios_has_progress() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("board-progress");
    std::fs::create_dir_all(&folder).unwrap();
    let path = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let (image, link) = (path("image.bin"), path("port"));
    make_image(&[], &image);
    let program = env!("CARGO_BIN_EXE_glint");
    for start in [&["--bios"][..], &["--flash", &image]] {
        let board = ["-c", "exec \"$0\" board --verbose --pty \"$@\" 2>&1"];
        let arguments = [&board[..], &[program, &link], start].concat();
        let mut terminal = Terminal::start(Path::new("sh"), &arguments);
        terminal.wait_for("the board starts: ", &mut patience(PATIENCE));
    }
    let mut board = board::emulated_bios().unwrap();
    let meter = board.meter();
    board.read(&mut Vec::new(), 1).unwrap();
    assert_eq!(meter.cycles(), board.inner().cycles());
    let port = Pty::start(board).unwrap();
    let counted = port.with(move |board| (meter.cycles(), board.inner().cycles()));
    assert_eq!(counted.0, counted.1);
}

/// Sends a signal to a program, and waits for its end.
fn end_by(signal: &str, child: &mut Child) {
    let pid = child.id().to_string();
    let sent = Command::new("kill").args(["-s", signal, &pid]).status();
    assert!(sent.unwrap().success());
    let end = Instant::now() + Duration::from_secs(20);
    while child.try_wait().unwrap().is_none() {
        assert!(Instant::now() < end, "{signal} does not end the program");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// `glint flash` on a board in its own process: a request that has waited for seconds, and a boot whose host was killed.
#[test]
fn a_board_that_waits_for_a_program_can_always_be_flashed() {
    let stay = Stay::start_with("board-waits", &["--bios"]);
    let mut large = printer("Large program runs\n");
    // The longest flat binary: it loads for several seconds.
    large.resize(7 << 20, 0);
    std::fs::write(stay.folder.join("large.bin"), large).unwrap();
    let mut small = printer("Program runs\n");
    small.resize(1000, 0);
    std::fs::write(stay.folder.join("small.bin"), small).unwrap();
    std::thread::sleep(Duration::from_secs(3));
    let mut killed = Command::new(env!("CARGO_BIN_EXE_glint"))
        .args(["flash", "large.bin", "--board", "port"])
        .current_dir(&stay.folder)
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_secs(2));
    assert!(killed.try_wait().unwrap().is_none());
    end_by("TERM", &mut killed);
    stay.succeed("flash small.bin --board port", "");
}

/// Signals end `glint board` even if the program on the board prints no prompt, or nothing.
#[test]
fn a_board_without_a_prompt_ends_by_a_signal() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("board-programs");
    std::fs::create_dir_all(&folder).unwrap();
    for (name, program) in [("mute", MUTE.to_vec()), ("printer", printer("no prompt\n"))] {
        let file = folder.join(name);
        std::fs::write(&file, program).unwrap();
        let link = folder.join("port");
        for options in [&["--pty", link.to_str().unwrap()][..], &["--web"]] {
            for signal in ["INT", "TERM", "HUP"] {
                let mut child = Command::new(env!("CARGO_BIN_EXE_glint"))
                    .args(["board", "--firmware", file.to_str().unwrap()])
                    .args(options)
                    .stdout(Stdio::piped())
                    .spawn()
                    .unwrap();
                let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
                assert!(lines.next().unwrap().is_ok(), "the address");
                end_by(signal, &mut child);
            }
        }
        assert!(!link.is_symlink());
    }
}

/// The console of `glint board` on a terminal ends by a signal too.
#[test]
fn the_console_of_a_board_ends_by_a_signal() {
    let mut terminal = Terminal::start(Path::new(env!("CARGO_BIN_EXE_glint")), &["board"]);
    terminal.wait_for("glint> ", &mut patience(PATIENCE));
    end_by("TERM", &mut terminal.child);
}
