//! The page with a board on a serial port of the browser. The port is a fake, and the board behind it an emulated one in WebAssembly, which
//! starts with the BIOS. Requires the build of `cargo xtask web`.

use crate::alone::{FOLDER, Files};
use crate::browser::{Browser, Page};
use crate::page::wait_for_picture;
use crate::upload::drop_files;
use glint::board::{self, EmulatedBoard, SimulatedBoard, built_firmware};
use glint::console::Console;
use glint::convert::Options;
use glint::{formats, generate, transfer};
use glint_board_api::built;
use std::fs;
use std::path::{Path, PathBuf};

const LOG: &str = "document.getElementById('log').textContent";
const NOTICE: &str = "document.getElementById('notice').textContent";
const BOARD: &str = "document.getElementById('board').textContent";
const BUTTON: &str = "document.getElementById('connect')";

/// Name of the uploaded file.
const FILE: &str = "teapot.ply";

/// The file of a mesh.
fn mesh() -> Vec<u8> {
    let mut file = Vec::new();
    formats::write::ply(&generate::named("teapot").unwrap(), &mut file).unwrap();
    file
}

/// The screenshot of the page in the documentation.
fn documented() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/pictures/page-connected.png")
}

/// A folder with the page and the files of the fake port.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for file in fs::read_dir(FOLDER).unwrap() {
        let file = file.unwrap();
        fs::copy(file.path(), folder.path().join(file.file_name())).unwrap();
    }
    let target = "wasm32-unknown-unknown/wasm/examples/pipe.wasm";
    let pipe = built::find(target, "cargo xtask web").unwrap();
    fs::copy(pipe, folder.path().join("pipe.wasm")).unwrap();
    let bios = "gateware/virtual/software/bios/bios.bin";
    let bios = built::find(bios, "cargo xtask gateware").unwrap();
    fs::copy(bios, folder.path().join("bios.bin")).unwrap();
    fs::write(folder.path().join("pipe.js"), include_str!("pipe.js")).unwrap();
    folder
}

/// Changes the fake port, or the user's choice of it.
fn change(browser: &mut Browser, page: &Page, code: &str) {
    let code = format!("import('./pipe.js').then(({{ port, user }}) => {{ {code} }})");
    browser.evaluate(page, &code);
}

/// Presses the button that connects the board, and waits until it has acted.
fn press_connect(browser: &mut Browser, page: &Page) {
    browser.evaluate(page, &format!("{BUTTON}.click()"));
    browser.wait(page, &format!("!{BUTTON}.disabled"));
}

/// Presses the button of a program.
fn press_program(browser: &mut Browser, page: &Page, name: &str) {
    let press = format!(
        "[...document.querySelectorAll('#programs button')].find(({{ textContent }}) => textContent === '{name}').click()"
    );
    browser.evaluate(page, &press);
}

fn command(browser: &mut Browser, page: &Page, line: &str) {
    browser.evaluate(page, "document.getElementById('line').focus()");
    browser.type_line(page, line);
}

/// Another board after the same commands and the same upload.
fn other() -> SimulatedBoard<EmulatedBoard> {
    let mut board = board::emulated(&built_firmware(None).unwrap()).unwrap();
    let model = glint::model::of_file(FILE, mesh(), Options::default(), &mut |_| None);
    let model = model.unwrap();
    let mut console = Console::new(&mut board);
    console.greet().unwrap();
    transfer::upload(&mut console, &model.mesh, None, 1, &mut |_, _| {}).unwrap();
    transfer::show(&mut console, transfer::MODEL, model.up).unwrap();
    for line in ["quality fast", "render"] {
        console.command(line).unwrap();
    }
    board
}

#[test]
fn a_browser_that_cannot_wait_for_a_port_is_told() {
    let files = Files::start();
    let mut browser = Browser::start();
    let page = browser.open_with(&files.url, "delete WebAssembly.Suspending");
    browser.wait(&page, "document.body.dataset.holder === 'you'");
    browser.wait(&page, "!document.getElementById('no-serial').hidden");
    browser.wait(&page, &format!("{BUTTON}.hidden"));
}

/// With the environment variable `GLINT_UPDATE`, replaces the screenshot in the documentation.
#[test]
fn a_board_on_a_port_of_the_browser_is_loaded_and_used() {
    let folder = folder();
    let files = Files::of(folder.path());
    let mut browser = Browser::start();
    let page = browser.open(&files.url);
    browser.wait(&page, "document.body.dataset.holder === 'you'");

    // A list of ports that is closed without a choice changes nothing, nor does a port that another program uses.
    change(&mut browser, &page, "user.hasChosen = false");
    press_connect(&mut browser, &page);
    browser.wait(&page, "document.getElementById('notice').hidden");
    change(
        &mut browser,
        &page,
        "user.hasChosen = true; port.isTaken = true",
    );
    press_connect(&mut browser, &page);
    let taken = "The serial port cannot be opened. Expected a port that this user may open";
    browser.wait(&page, &format!("{NOTICE}.startsWith('{taken}')"));
    browser.wait(&page, &format!("{BOARD} === 'board emulated'"));
    change(&mut browser, &page, "port.isTaken = false");

    // The console of the BIOS. It receives a line that the user has entered before the session has started.
    let enter = format!(
        "new Promise((done) => {{
            new MutationObserver((_, observer) => {{
                observer.disconnect();
                document.getElementById('line').value = 'ident';
                document.getElementById('command').requestSubmit();
                done(document.body.dataset.holder);
            }}).observe({BUTTON}, {{ childList: true }});
            {BUTTON}.click();
        }})"
    );
    // The emulated board's page had control.
    assert_eq!(browser.evaluate(&page, &enter), "nobody");
    let named = "board on a serial port, USB 0403:6010";
    browser.wait(&page, &format!("{BOARD} === '{named}'"));
    browser.wait(
        &page,
        &format!("{NOTICE}.includes('found the prompt of the BIOS')"),
    );
    browser.wait(&page, "document.getElementById('scenes').hidden");
    browser.wait(&page, &format!("{LOG}.includes('Ident: ')"));
    let notice = browser.evaluate(&page, NOTICE);
    assert!(
        !notice.as_str().unwrap().contains("has stopped"),
        "{notice}"
    );
    command(&mut browser, &page, "help");
    browser.wait(
        &page,
        &format!("{LOG}.includes('LiteX BIOS, available commands')"),
    );
    drop_files(&mut browser, &page, &[(FILE, mesh())]);
    let refused = "expected the prompt of the firmware, found none";
    browser.wait(&page, &format!("{NOTICE}.startsWith('{refused}')"));

    // The firmware, its console, and a model.
    press_program(&mut browser, &page, "firmware");
    browser.wait(
        &page,
        &format!("{NOTICE}.startsWith('firmware.bin: the board receives ')"),
    );
    browser.wait(&page, "!document.getElementById('progress').hidden");
    browser.wait(
        &page,
        &format!("{NOTICE}.startsWith('firmware.bin runs, ')"),
    );
    browser.wait(&page, &format!("{LOG}.includes('Liftoff!')"));
    browser.wait(
        &page,
        "document.querySelectorAll('#scenes button').length > 10",
    );
    // The upload is in progress when it is stopped, because the port accepts only its start.
    let start = "port.accept(20_000)";
    change(&mut browser, &page, start);
    drop_files(&mut browser, &page, &[(FILE, mesh())]);
    browser.wait(&page, "!document.getElementById('progress').hidden");
    browser.evaluate(&page, "document.getElementById('interrupt').click()");
    change(&mut browser, &page, "port.accept(Infinity)");
    browser.wait(&page, &format!("{NOTICE} === 'stopped'"));
    browser.wait(&page, "document.getElementById('progress').hidden");
    drop_files(&mut browser, &page, &[(FILE, mesh())]);
    browser.wait(&page, &format!("{NOTICE}.startsWith('the model is shown')"));
    command(&mut browser, &page, "quality fast");
    command(&mut browser, &page, "render");
    browser.wait(&page, &format!("{LOG}.includes('triangles_drawn')"));
    browser.evaluate(&page, "document.getElementById('fetch').click()");
    wait_for_picture(&mut browser, &page, &mut other());
    if std::env::var_os("GLINT_UPDATE").is_some() {
        browser.evaluate(&page, "scrollTo(0, 0)");
        fs::write(documented(), browser.picture(&page)).unwrap();
    }

    // A program in place of the firmware, whose fault is found in its sources.
    let faults = built::find("firmware/programs/faults.elf", "cargo xtask programs").unwrap();
    let faults = fs::read(faults).unwrap();
    drop_files(&mut browser, &page, &[("faults.elf", faults)]);
    browser.wait(&page, &format!("{NOTICE}.startsWith('faults.elf runs, ')"));
    change(&mut browser, &page, "port.board.set_switches(1 << 4)");
    for text in ["trap: illegal instruction", " is in update, "] {
        browser.wait(&page, &format!("{LOG}.includes('{text}')"));
    }

    // The program does not answer, so the next one waits for the reset button, until Stop.
    press_program(&mut browser, &page, "kernel");
    let waiting = "waiting for the board's BIOS";
    browser.wait(&page, &format!("{NOTICE}.includes(\"{waiting}\")"));
    browser.evaluate(&page, "document.getElementById('interrupt').click()");
    browser.wait(&page, &format!("{NOTICE} === 'kernel.bin: stopped'"));

    // The cable is lost; then the board is connected again, and given up.
    change(&mut browser, &page, "port.unplug()");
    let lost = "The serial port has failed: The device has been lost. Check the cable";
    browser.wait(&page, &format!("{NOTICE}.startsWith('{lost}')"));
    browser.wait(&page, "document.getElementById('line').disabled");
    press_connect(&mut browser, &page);
    browser.wait(&page, "document.body.dataset.holder === 'you'");
    browser.wait(&page, &format!("{BUTTON}.textContent === 'Disconnect'"));
    press_connect(&mut browser, &page);
    browser.wait(&page, &format!("{BOARD} === 'board emulated'"));
    browser.wait(
        &page,
        &format!("{BUTTON}.textContent === 'Connect a board'"),
    );
    change(
        &mut browser,
        &page,
        "if (port.readable) throw Error('the port is open')",
    );

    // The worker of the next connection cannot be loaded: the port is closed, and may be opened again.
    let broken = "Worker = class extends Worker { constructor() { super('nothing.js', { type: 'module' }); } }; 0";
    browser.evaluate(&page, broken);
    press_connect(&mut browser, &page);
    let stopped = "The board\\'s program on this page has stopped: ";
    browser.wait(&page, &format!("{NOTICE}.startsWith('{stopped}')"));
    let free = format!("!{BUTTON}.disabled && {BUTTON}.textContent === 'Connect a board'");
    browser.wait(&page, &free);
    change(
        &mut browser,
        &page,
        "if (port.readable) throw Error('the port is open')",
    );

    // The button fits a narrow display.
    browser.call(
        Some(&page),
        "Emulation.setDeviceMetricsOverride",
        serde_json::json!({ "width": 320, "height": 640, "deviceScaleFactor": 1, "mobile": true }),
    );
    browser.wait(&page, "document.documentElement.scrollWidth === 320");
}
