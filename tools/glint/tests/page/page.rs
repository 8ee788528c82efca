//! The page in a browser.

use crate::browser::{Browser, Page};
use crate::served::Served;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glint::board::{self, EmulatedBoard, SimulatedBoard, built_firmware};
use glint::console::Console;
use glint::convert::Options;
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
    let mut board = board::emulated(&built_firmware(None).unwrap()).unwrap();
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

    // The sensor, turned with the mouse, turns the camera.
    browser.type_line(&page, "imu look");
    let angle = "Number(document.querySelector('#curve-attitude span')?.textContent.split(' ')[1])";
    browser.wait(&page, &format!("Math.abs({angle}) < 0.5"));
    let sensor = browser.middle(&page, "#sensor");
    browser.mouse(&page, "mousePressed", sensor);
    browser.mouse(&page, "mouseMoved", [sensor[0] + 40.0, sensor[1]]);
    browser.mouse(&page, "mouseReleased", [sensor[0] + 40.0, sensor[1]]);
    browser.wait(
        &page,
        &format!("Math.abs({angle} - 0.5 * 180 / Math.PI) < 0.5"),
    );

    // A dropped mesh is shown.
    browser.evaluate(&page, "document.getElementById('line').focus()");
    for command in ["imu off", "camera 2.5 -30 75", "field off"] {
        browser.type_line(&page, command);
    }
    let mesh = "v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nv 0 0 1\\nf 1 3 2\\nf 1 2 4\\nf 2 3 4\\nf 3 1 4\\n";
    let file = "const data = new DataTransfer(); data.items.add(new File([text], 'corner.obj'))";
    let event = "new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true })";
    browser.evaluate(
        &page,
        &format!("{{ const text = '{mesh}'; {file}; document.body.dispatchEvent({event}); }} 0"),
    );
    browser.wait(
        &page,
        "document.getElementById('notice').textContent.startsWith('the model is shown')",
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("corner.obj");
    std::fs::write(&path, mesh.replace("\\n", "\n")).unwrap();
    let model = glint::model::load(path.to_str().unwrap(), Options::default()).unwrap();
    let mut console = Console::new(&mut board);
    glint::transfer::upload(&mut console, &model.mesh, None, 1, &mut |_, _| {}).unwrap();
    for command in ["camera 2.5 -30 75", "render"] {
        browser.type_line(&page, command);
        console.command(command).unwrap();
    }
    wait_for_picture(&mut browser, &page, &mut board);

    if std::env::var_os("GLINT_UPDATE").is_some() {
        for command in ["scene mesh-in-field", "render"] {
            browser.type_line(&page, command);
            Console::new(&mut board).command(command).unwrap();
        }
        wait_for_picture(&mut browser, &page, &mut board);
        browser.evaluate(&page, "scrollTo(0, 0)");
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

/// Prints the pictures a second in the page, and the time from a key to the picture: `cargo test -p glint --test page -- --ignored
/// --nocapture`.
#[test]
#[ignore = "a measurement"]
fn rates() {
    let served = Served::start("page-rates");
    let mut browser = Browser::start();
    let page = browser.open(&served.url);
    browser.wait(&page, "document.body.dataset.holder === 'you'");
    // About 20° to either side, so that the sponge stays in view.
    let turn = "dispatch(new KeyboardEvent('keydown', { key: ['ArrowLeft', 'ArrowRight'][Math.floor(performance.now() / 160) % 2] }))";
    let hand = "dispatch(new PointerEvent('pointermove', { buttons: 1, clientX: box.x + box.width * (0.5 + 0.2 * Math.sin(performance.now() / 640)), clientY: box.y + box.height * (0.5 + 0.2 * Math.cos(performance.now() / 640)) }))";
    for (scene, element, event) in [
        ("holoforge", "hand", hand),
        ("poor-mans-vr", "sensor", turn),
    ] {
        browser.evaluate(&page, "document.getElementById('line').focus()");
        browser.type_line(&page, &format!("scene {scene}"));
        browser.type_line(&page, "size 320 180");
        let rate = browser.evaluate(
            &page,
            &format!(
                "new Promise((done) => {{ const element = document.getElementById('{element}'); \
                 const dispatch = (event) => element.dispatchEvent(event); let steps = 0, first = 0, start = 0; \
                 const shown = () => Number(document.getElementById('monitor').dataset.number); \
                 const step = () => {{ const box = element.getBoundingClientRect(); {event}; steps += 1; \
                 if (steps === 150) [first, start] = [shown(), performance.now()]; \
                 if (steps === 450) done([(shown() - first) * 1000 / (performance.now() - start), \
                 Number(document.getElementById('rate').textContent)]); else setTimeout(step, 20); }}; step(); }})"
            ),
        );
        println!(
            "{scene}: {rate} pictures a second made by the board, and painted in the last second"
        );
    }
    browser.type_line(&page, "imu off");
    browser.type_line(&page, "scene cube");
    let mut times = Vec::new();
    for number in 0..20 {
        let time = browser.evaluate(
            &page,
            &format!(
                "new Promise((done) => {{ const canvas = document.getElementById('monitor'); const before = canvas.dataset.number; \
                 const line = document.getElementById('line'); line.value = 'camera 3 {} 60'; const start = performance.now(); \
                 document.getElementById('command').requestSubmit(); \
                 const look = () => canvas.dataset.number === before ? setTimeout(look, 1) : done(performance.now() - start); look(); }})",
                number * 10
            ),
        );
        times.push(time.as_f64().unwrap());
    }
    times.sort_by(f64::total_cmp);
    println!(
        "key to picture: median {:.0} ms, longest {:.0} ms",
        times[10], times[19]
    );
}
