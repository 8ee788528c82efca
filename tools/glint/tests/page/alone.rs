//! The page with its own board in WebAssembly, served by a web server for static files. Requires
//! the build of `cargo xtask web`.

use crate::browser::Browser;
use crate::page::exercise;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// The output folder of `cargo xtask web`.
pub const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../target/web");

/// Python's web server for files, which serves the page.
pub struct Files {
    child: Child,
    /// Address of the page.
    pub url: String,
}

impl Files {
    /// Starts the web server.
    pub fn start() -> Self {
        let board = Path::new(FOLDER).join("board.wasm");
        assert!(board.exists(), "run `cargo xtask web`");
        Self::of(Path::new(FOLDER))
    }

    /// Starts the web server for the files of a folder.
    pub fn of(folder: &Path) -> Self {
        let mut child = Command::new("python3")
            .args(["-u", "-m", "http.server", "0", "--bind", "127.0.0.1"])
            .arg("--directory")
            .arg(folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // `Serving HTTP on 127.0.0.1 port 40123 (http://127.0.0.1:40123/) ...`
        let mut line = String::new();
        let mut output = BufReader::new(child.stdout.take().unwrap());
        output.read_line(&mut line).unwrap();
        let url = line.split(['(', ')']).nth(1).unwrap().to_owned();
        Self { child, url }
    }
}

impl Drop for Files {
    fn drop(&mut self) {
        // An error means that the server has already ended, which has made the test fail.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn the_board_runs_in_the_browser() {
    let files = Files::start();
    let mut browser = Browser::start();
    let page = browser.open(&files.url);
    exercise(&mut browser, &page);
    browser.wait(
        &page,
        "getComputedStyle(document.getElementById('control')).display === 'none'",
    );

    // Without its firmware, the page states why the board does not run.
    let folder = tempfile::tempdir().unwrap();
    for file in std::fs::read_dir(FOLDER).unwrap() {
        let file = file.unwrap();
        if file.file_name() != "firmware.bin" {
            std::fs::copy(file.path(), folder.path().join(file.file_name())).unwrap();
        }
    }
    let files = Files::of(folder.path());
    let page = browser.open(&files.url);
    browser.wait(
        &page,
        "/firmware.bin: expected a file/.test(document.getElementById('notice').textContent)",
    );
}
