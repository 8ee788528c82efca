//! The page in a browser.

use crate::browser::{Browser, Page};
use crate::served::Served;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glint::board::{EmulatedBoard, SimulatedBoard, built_firmware};
use glint::console::Console;
use std::path::{Path, PathBuf};

/// The colours on the canvas of a page, as text.
const CANVAS: &str = "(() => { const canvas = document.getElementById('monitor'); \
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height); \
    let text = ''; for (let i = 0; i < data.length; i += 30000) text += String.fromCharCode(...data.subarray(i, i + 30000)); \
    return btoa(text); })()";

/// Waits until the picture in the page equals that on the monitor of a board, bit for bit.
fn wait_for_picture(browser: &mut Browser, page: &Page, board: &mut SimulatedBoard<EmulatedBoard>) {
    let frame = board.inner().capture().pixels;
    let widened = frame.iter().flat_map(|&colour| {
        let [r, g, b] = [colour >> 11, colour >> 5 & 63, colour & 31];
        [r << 3 | r >> 2, g << 2 | g >> 4, b << 3 | b >> 2, 255].map(|c| c as u8)
    });
    let text = STANDARD.encode(widened.collect::<Vec<u8>>());
    browser.evaluate(page, &format!("globalThis.expected = '{text}'; 0"));
    browser.wait(page, &format!("{CANVAS} === expected"));
}

/// The picture of the page in the documents.
fn documented() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/pictures/page.png")
}

/// With `GLINT_UPDATE` in the environment, replaces the picture of the page in the documents.
#[test]
fn a_board_in_a_browser() {
    let served = Served::start("page-browser");
    let mut browser = Browser::start();
    let mut board = SimulatedBoard::emulated(&built_firmware(None).unwrap()).unwrap();
    Console::new(&mut board).greet().unwrap();

    let page = browser.open(&served.url);
    browser.wait(&page, "document.body.dataset.holder === 'you'");
    browser.wait(
        &page,
        "document.querySelectorAll('#scenes button').length > 10",
    );

    // A command changes the picture.
    for command in ["camera 3 40 60", "render", "camera 2.5 -30 75", "render"] {
        browser.evaluate(&page, "document.getElementById('line').focus()");
        browser.type_line(&page, command);
        Console::new(&mut board).command(command).unwrap();
        if command == "render" {
            wait_for_picture(&mut browser, &page, &mut board);
        }
    }
    browser.wait(
        &page,
        "document.getElementById('log').textContent.includes('triangles_drawn')",
    );

    // Completion and history.
    browser.call(
        Some(&page),
        "Input.insertText",
        serde_json::json!({ "text": "back" }),
    );
    browser.press(&page, "Tab", "");
    browser.wait(&page, "document.getElementById('line').value === 'back'");
    browser.wait(
        &page,
        "document.getElementById('hint').textContent === 'background  backend'",
    );
    browser.press(&page, "ArrowUp", "");
    browser.wait(&page, "document.getElementById('line').value === 'render'");

    // Switches, LEDs, digits and buttons.
    browser.evaluate(&page, "document.getElementById('line').value = ''; 0");
    browser.type_line(&page, "leds 0x8001");
    browser.wait(
        &page,
        "document.getElementById('leds').ariaLabel === 'LEDs lit: 0 15'",
    );
    browser.evaluate(
        &page,
        "document.querySelector('[aria-label=\"switch 3\"]').click()",
    );
    let button = browser.middle(&page, "#buttons button:nth-of-type(2)");
    browser.mouse(&page, "mousePressed", button);
    browser.wait(
        &page,
        "document.querySelector('[aria-pressed=true]')?.textContent === 'BTN1'",
    );
    browser.evaluate(&page, "document.getElementById('line').focus()");
    browser.wait(&page, "!document.querySelector('[aria-pressed=true]')");
    browser.mouse(&page, "mouseReleased", button);
    browser.evaluate(&page, "document.getElementById('line').focus()");
    browser.type_line(&page, "buttons");
    browser.wait(
        &page,
        "/switches 0x0008/.test(document.getElementById('log').textContent)",
    );

    if std::env::var_os("GLINT_UPDATE").is_some() {
        for command in ["scene mesh-in-field", "render"] {
            browser.type_line(&page, command);
            Console::new(&mut board).command(command).unwrap();
        }
        wait_for_picture(&mut browser, &page, &mut board);
        std::fs::write(documented(), browser.picture(&page)).unwrap();
    }

    // A second page sees the same picture, and cannot steer.
    let second = browser.open(&served.url);
    browser.wait(&second, "document.body.dataset.holder === 'other'");
    wait_for_picture(&mut browser, &second, &mut board);
    browser.wait(&second, "document.getElementById('line').disabled");
    browser.evaluate(&page, "document.getElementById('control').click()");
    browser.wait(&second, "document.body.dataset.holder === 'nobody'");
    browser.evaluate(&second, "document.getElementById('control').click()");
    browser.wait(&second, "document.body.dataset.holder === 'you'");
    browser.wait(&page, "document.getElementById('line').disabled");
}
