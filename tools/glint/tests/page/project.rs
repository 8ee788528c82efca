//! The commands of the page of programs, from nothing to a program in the browser and on boards; and a project with a git source.

use crate::browser::Browser;
use glint::board::{Board, SerialBoard};
use glint::project;
use serde_json::Value;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use std::{env, fs};
use tempfile::TempDir;

/// Longest wait for the output of another process.
const PATIENCE: Duration = Duration::from_secs(60);

/// A process that is killed when this value is dropped. `cargo run` replaces its own process by the program, so this also ends the program.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // The process may have ended.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The folder of the clone.
fn root() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.canonicalize().unwrap()
}

/// The folder that a variable names, by default a folder in the user's home.
fn of_user(variable: &str, default: &str) -> PathBuf {
    let folder = env::var_os(variable).map(PathBuf::from);
    folder.unwrap_or_else(|| env::home_dir().unwrap().join(default))
}

/// A user with a clone of Glint, a Rust compiler and a linker, in a folder outside of the clone that is removed with this value.
struct User {
    home: TempDir,
    /// The current folder.
    folder: PathBuf,
}

impl User {
    fn new() -> Self {
        let home = tempfile::tempdir().unwrap();
        let programs = home.path().join("bin");
        fs::create_dir(&programs).unwrap();
        // Only the downloaded packages are those of the user who runs the tests.
        let cargo = home.path().join(".cargo");
        fs::create_dir(&cargo).unwrap();
        let packages = of_user("CARGO_HOME", ".cargo").join("registry");
        symlink(packages, cargo.join("registry")).unwrap();
        let path = env::var_os("PATH").unwrap();
        for name in ["cargo", "rustc", "cc", "ld"] {
            let mut found = env::split_paths(&path).map(|folder| folder.join(name));
            let found = found.find(|program| program.exists());
            symlink(found.expect(name), programs.join(name)).unwrap();
        }
        let folder = home.path().to_owned();
        Self { home, folder }
    }

    /// A command without the environment of the tests.
    fn command(&self, line: &str) -> Command {
        let mut words = line.split(' ');
        let programs = self.home.path().join("bin");
        let mut command = Command::new(programs.join(words.next().unwrap()));
        command.args(words).current_dir(&self.folder).env_clear();
        command.envs(env::var_os("RUSTUP_TOOLCHAIN").map(|name| ("RUSTUP_TOOLCHAIN", name)));
        command
            .env("PATH", programs)
            .env("RUSTUP_HOME", of_user("RUSTUP_HOME", ".rustup"))
            .env("CARGO_HOME", self.home.path().join(".cargo"))
            .env("CARGO_NET_OFFLINE", "true")
            // The library is compiled once for all runs of the tests.
            .env("CARGO_TARGET_DIR", env!("CARGO_TARGET_TMPDIR"))
            .env("CARGO_INCREMENTAL", "0");
        command
    }

    /// Runs a command, and returns its output.
    fn run(&self, line: &str) -> String {
        let output = self.command(line).output().unwrap();
        assert!(output.status.success(), "{line}: {output:?}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// Does what `cargo install --path` does. The tests have built the program already, but with other features of some packages than cargo
    /// selects for this command, so that cargo would build half of the program again.
    fn install(&self, path: &str) {
        let package = root().join(path).canonicalize().unwrap();
        assert_eq!(package, Path::new(env!("CARGO_MANIFEST_DIR")));
        let installed = self.home.path().join("bin/glint");
        fs::copy(env!("CARGO_BIN_EXE_glint"), installed).unwrap();
        let name = format!("glint 0.1.0 (path+file://{})", package.display());
        let list = serde_json::json!({ "installs": { name: {} } }).to_string();
        fs::write(self.home.path().join(".cargo/.crates2.json"), list).unwrap();
    }
}

/// Starts a command that runs until it is killed, and returns its first line of output.
fn start(command: &mut Command) -> (Running, String) {
    let mut running = Running(command.stdout(Stdio::piped()).spawn().unwrap());
    let output = running.0.stdout.take().unwrap();
    let mut first = String::new();
    BufReader::new(output).read_line(&mut first).unwrap();
    (running, first.trim().to_owned())
}

/// The lines of the first block of code on the page of programs, and the commands in the table after it.
fn page_of_programs() -> (Vec<String>, Vec<String>) {
    let page = fs::read_to_string(root().join("docs/programs.md")).unwrap();
    let (_, page) = page.split_once("```sh\n").unwrap();
    let (block, page) = page.split_once("```\n").unwrap();
    let (_, table) = page
        .split_once("| command in the project | action |\n|---|---|\n")
        .unwrap();
    let rows = table.lines().map_while(|line| line.strip_prefix("| `"));
    let commands = rows.map(|row| row.split_once('`').unwrap().0.to_owned());
    (
        block.lines().map(str::to_owned).collect(),
        commands.collect(),
    )
}

#[test]
fn the_commands_of_the_page_lead_to_programs_in_the_browser_and_on_boards() {
    let mut user = User::new();
    let (block, table) = page_of_programs();
    let greeting = "hello: hold button 0 to stop the cube";
    let mut shown = 0;
    for line in &block {
        match line.split(' ').collect::<Vec<_>>()[..] {
            ["rustup", "target", "add", target] => assert!(project::has_target(target), "{target}"),
            ["cargo", "install", "--path", path] => user.install(path),
            ["glint", "new", _] => drop(user.run(line)),
            ["cd", folder] => user.folder.push(folder),
            ["cargo", "run"] => {
                let (_running, address) = start(&mut user.command(line));
                let mut browser = Browser::start();
                let page = browser.open(&address);
                let log = "document.getElementById('log').textContent";
                browser.wait(&page, &format!("{log}.includes('{greeting}')"));
                // Most of the background is bright.
                browser.wait_for_light(&page, 200_000);
                shown += 1;
            }
            _ => panic!("{line}: expected a command that this test knows"),
        }
    }
    assert_eq!(shown, 1);

    let elf =
        Path::new(env!("CARGO_TARGET_TMPDIR")).join("riscv32im-unknown-none-elf/release/hello");
    for row in &table {
        let line = row.replace("FILE", elf.to_str().unwrap());
        match &row[..] {
            // In the block.
            "cargo run" => {}
            "cargo host-test" => {
                let said = user.run(&line);
                let passed = said.matches("test result: ok. 1 passed").count();
                assert_eq!(passed, 2, "{said}");
            }
            "cargo run -- --seconds 1 --picture hello.png" => {
                let said = user.run(&line);
                assert!(said.contains(greeting), "{said}");
                let picture = File::open(user.folder.join("hello.png")).unwrap();
                let picture = png::Decoder::new(BufReader::new(picture)).read_info();
                assert_eq!(picture.unwrap().info().size(), (1280, 720));
            }
            "cargo build --release" => drop(user.run(&line)),
            "GLINT_HOME=CLONE glint board --firmware FILE --board virtual" => {
                let mut command = user.command(line.split_once(' ').unwrap().1);
                let (_running, port) = start(command.env("GLINT_HOME", root()));
                let mut board = SerialBoard::open(&port, 115_200).unwrap();
                let (mut said, end) = (Vec::new(), Instant::now() + PATIENCE);
                while !String::from_utf8_lossy(&said).contains(greeting) {
                    assert!(Instant::now() < end, "{said:?}");
                    board.read(&mut said, 100).unwrap();
                }
            }
            // The tests of `glint board` have an emulated board behind a port.
            "glint board --firmware FILE --board PORT" => {}
            "glint image make --firmware FILE …" => {
                drop(user.run(&line.replace('…', "--out hello.bin")));
                drop(user.run("glint image check hello.bin"));
            }
            _ => panic!("{row}: expected a command that this test knows"),
        }
    }
}

/// Cargo resolves the project and checks the repository out; the sources are those that the other project compiles. Without network, as the
/// lock file of the project has all packages of other authors.
#[test]
fn a_project_takes_the_library_from_a_git_repository() {
    let user = User::new();
    user.install("tools/glint");
    let bare = user.folder.join("glint.git").display().to_string();
    let git = |line: &str| {
        let mut git = Command::new("git");
        let output = git.args(line.split(' ')).current_dir(root()).output();
        let output = output.unwrap();
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let own = root().display().to_string();
    git(&format!("clone --bare --depth=1 file://{own} {bare}"));
    // No package has a file that a clone lacks.
    let ignored = git("ls-files --others --ignored --exclude-standard firmware");
    assert_eq!(ignored, "");

    let url = format!("file://{bare}");
    user.run(&format!("glint new hello --glint {url}"));
    let mut cargo = user
        .command("cargo metadata --format-version 1 --filter-platform riscv32im-unknown-none-elf");
    cargo.current_dir(user.folder.join("hello"));
    // Cargo counts a repository in a file as network. The proxy does not exist.
    cargo
        .env_remove("CARGO_NET_OFFLINE")
        .env("https_proxy", "http://127.0.0.1:9");
    let output = cargo.output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let packages = found["packages"].as_array().unwrap();
    for name in ["glint-program", "glint-core", "litex-pac"] {
        let package = packages.iter().find(|package| package["name"] == name);
        let source = package.unwrap()["source"].as_str().unwrap();
        assert!(source.starts_with(&format!("git+{url}#")), "{source}");
    }
}
