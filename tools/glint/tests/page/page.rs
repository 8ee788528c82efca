//! Tests of the page's controls in a browser.

use crate::browser::{Browser, Page};
use crate::served::Served;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glint::board::{self, EmulatedBoard, SimulatedBoard, built_firmware};
use glint::console::Console;
use glint::convert::Options;
use glint_core::field::EXAMPLES;
use std::path::{Path, PathBuf};

/// Returns the pixels of the page's canvas as text.
const CANVAS: &str = "(() => { const canvas = document.getElementById('monitor'); \
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height); \
    let text = ''; for (let i = 0; i < data.length; i += 30000) text += String.fromCharCode(...data.subarray(i, i + 30000)); \
    return btoa(text); })()";

/// The command that sets the camera of most pictures.
const CAMERA: &str = "camera 2.5 -30 75";

/// Waits until the picture in the page is bit-identical to the picture on a board's monitor.
pub fn wait_for_picture(
    browser: &mut Browser,
    page: &Page,
    board: &mut SimulatedBoard<EmulatedBoard>,
) {
    let frame = board.inner().capture().pixels;
    let widened = frame.iter().flat_map(|&colour| {
        let [r, g, b] = [colour >> 11, colour >> 5 & 63, colour & 31];
        [r << 3 | r >> 2, g << 2 | g >> 4, b << 3 | b >> 2, 255].map(|c| c as u8)
    });
    wait_for_pixels(browser, page, &widened.collect::<Vec<u8>>());
}

/// Waits until the picture in the page has these pixels: red, green, blue and opacity of each.
pub fn wait_for_pixels(browser: &mut Browser, page: &Page, pixels: &[u8]) {
    let text = STANDARD.encode(pixels);
    browser.evaluate(page, &format!("globalThis.expected = '{text}'; 0"));
    browser.wait(page, &format!("{CANVAS} === expected"));
}

/// Types commands on a page, and sends them to another board.
fn command_both(
    browser: &mut Browser,
    page: &Page,
    board: &mut SimulatedBoard<EmulatedBoard>,
    commands: &[&str],
) {
    browser.evaluate(page, "document.getElementById('line').focus()");
    for command in commands {
        browser.type_line(page, command);
        Console::new(board).command(command).unwrap();
    }
}

/// Types commands on a page.
fn command(browser: &mut Browser, page: &Page, commands: &[&str]) {
    browser.evaluate(page, "document.getElementById('line').focus()");
    for command in commands {
        browser.type_line(page, command);
    }
}

/// Uses all controls of an opened page. Returns a board with a bit-identical picture.
pub fn exercise(browser: &mut Browser, page: &Page) -> SimulatedBoard<EmulatedBoard> {
    let mut board = board::emulated(&built_firmware(None).unwrap()).unwrap();
    Console::new(&mut board).greet().unwrap();
    browser.wait(page, "document.body.dataset.holder === 'you'");
    browser.wait(
        page,
        "document.querySelectorAll('#scenes button').length > 10",
    );

    // A command changes the picture.
    for camera in ["camera 3 40 60", CAMERA] {
        command_both(browser, page, &mut board, &[camera, "render"]);
        wait_for_picture(browser, page, &mut board);
    }
    browser.wait(
        page,
        "document.getElementById('log').textContent.includes('triangles_drawn')",
    );
    complete_and_repeat(browser, page);
    use_pins(browser, page);
    turn_the_sensor(browser, page);
    move_the_hand(browser, page);
    for (curve, name) in [("time", "frame"), ("engine", "busy"), ("engine", "stalled")] {
        let caption = format!("document.querySelector('#curve-{curve} figcaption').textContent");
        browser.wait(page, &format!("/{name} [0-9]/.test({caption})"));
    }

    // The page states why the soft core draws.
    let scene = ["scene sphere", "shading smooth", "orthographic 3"];
    command(browser, page, &scene);
    let fallback = "document.getElementById('remarks').textContent";
    let reason = "no smooth shading in orthographic projection.";
    browser.wait(page, &format!("{fallback}.endsWith('{reason}')"));
    command(browser, page, &["scene default"]);
    browser.wait(page, &format!("{fallback} === ''"));

    // Choosing a field draws it.
    command(browser, page, &["imu off", "gesture off"]);
    let scene = ["scene cube", "quality fast", CAMERA];
    command_both(browser, page, &mut board, &scene);
    browser.evaluate(
        page,
        "[...document.querySelectorAll('#fields button')].find((button) => button.textContent === 'octahedron').click()",
    );
    let mut examples = EXAMPLES.iter();
    let example = examples.find(|example| example.field.starts_with("octahedron"));
    let example = example.unwrap();
    let field = format!("field {}", example.field);
    for line in ["scene default"].iter().chain(example.look) {
        Console::new(&mut board).command(line).unwrap();
    }
    Console::new(&mut board).command(&field).unwrap();
    browser.wait(
        page,
        &format!("document.getElementById('log').textContent.trimEnd().endsWith('{field}\\nok')"),
    );
    browser.evaluate(page, "document.getElementById('line').focus()");
    command_both(browser, page, &mut board, &["render"]);
    wait_for_picture(browser, page, &mut board);

    // Dropping a mesh draws it.
    command_both(browser, page, &mut board, &["field off"]);
    drop_a_mesh(browser, page, &mut board);
    command_both(browser, page, &mut board, &["render"]);
    wait_for_picture(browser, page, &mut board);
    browser.wait(page, "document.getElementById('notice').hidden");

    command_both(
        browser,
        page,
        &mut board,
        &["scene mesh-in-field", "render"],
    );
    wait_for_picture(browser, page, &mut board);
    board
}

/// Completes a command, and recalls an earlier command.
fn complete_and_repeat(browser: &mut Browser, page: &Page) {
    browser.call(
        Some(page),
        "Input.insertText",
        serde_json::json!({ "text": "back" }),
    );
    browser.press(page, "Tab", "");
    browser.wait(page, "document.getElementById('line').value === 'back'");
    browser.wait(
        page,
        "document.getElementById('hint').textContent === 'background  backend'",
    );
    browser.press(page, "ArrowUp", "");
    browser.wait(page, "document.getElementById('line').value === 'render'");
    // A pasted line may contain tabs.
    browser.evaluate(
        page,
        "document.getElementById('line').value = 'leds\\t2'; document.getElementById('command').requestSubmit()",
    );
    browser.wait(
        page,
        "document.getElementById('leds').ariaLabel === 'LEDs lit: 1'",
    );
}

/// Uses switches, LEDs and buttons.
fn use_pins(browser: &mut Browser, page: &Page) {
    command(browser, page, &["leds 0x8001"]);
    browser.wait(
        page,
        "document.getElementById('leds').ariaLabel === 'LEDs lit: 0 15'",
    );
    browser.evaluate(
        page,
        "document.querySelector('[aria-label=\"switch 3\"]').click()",
    );
    let button = browser.middle(page, "#buttons button:nth-of-type(2)");
    browser.mouse(page, "mousePressed", button);
    browser.wait(
        page,
        "document.querySelector('[aria-pressed=true]')?.textContent === 'BTN1'",
    );
    browser.evaluate(page, "document.getElementById('line').focus()");
    browser.wait(page, "!document.querySelector('[aria-pressed=true]')");
    browser.mouse(page, "mouseReleased", button);
    command(browser, page, &["buttons"]);
    browser.wait(
        page,
        "/switches 0x0008/.test(document.getElementById('log').textContent)",
    );
}

/// Turns the sensor, and with it the camera, by the mouse and by the orientation of a device.
fn turn_the_sensor(browser: &mut Browser, page: &Page) {
    command(browser, page, &["imu look"]);
    let angle = "Number(document.querySelector('#curve-attitude span')?.textContent.split(' ')[1])";
    browser.wait(page, &format!("Math.abs({angle}) < 0.5"));
    let sensor = browser.middle(page, "#sensor");
    browser.mouse(page, "mousePressed", sensor);
    browser.mouse(page, "mouseMoved", [sensor[0] + 40.0, sensor[1]]);
    browser.mouse(page, "mouseReleased", [sensor[0] + 40.0, sensor[1]]);
    browser.wait(
        page,
        &format!("Math.abs({angle} - 0.5 * 180 / Math.PI) < 0.5"),
    );
    browser.evaluate(page, "document.getElementById('device').click()");
    let event =
        "new DeviceOrientationEvent('deviceorientation', { alpha: -20, beta: 0, gamma: 0 })";
    browser.wait(
        page,
        &format!("(dispatchEvent({event}), Math.abs({angle} + 20) < 0.5)"),
    );
    browser.evaluate(page, "document.getElementById('device').click()");
}

/// Moves the hand, and with it the camera, by the mouse. Each move gives several pictures.
fn move_the_hand(browser: &mut Browser, page: &Page) {
    command(browser, page, &["scene holoforge"]);
    let hand = browser.middle(page, "#hand");
    browser.mouse(page, "mousePressed", hand);
    let number = "Number(document.getElementById('monitor').dataset.number)";
    for step in 1..=4 {
        let before = browser.evaluate(page, number);
        let place = [hand[0] + 15.0 * f64::from(step), hand[1]];
        browser.mouse(page, "mouseMoved", place);
        browser.wait(page, &format!("{number} > {before} + 3"));
    }
    browser.mouse(page, "mouseReleased", hand);
    browser.evaluate(page, "document.getElementById('away').click()");
}

/// Drops a mesh on the page, and uploads it to another board.
fn drop_a_mesh(browser: &mut Browser, page: &Page, board: &mut SimulatedBoard<EmulatedBoard>) {
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    let name = "corner.obj";
    // The page selects the mesh among several dropped files.
    let file = format!(
        "const data = new DataTransfer(); data.items.add(new File(['newmtl a'], 'corner.mtl')); \
         data.items.add(new File([{mesh:?}], '{name}'))"
    );
    let event = "new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true })";
    browser.evaluate(
        page,
        &format!("{{ {file}; document.body.dispatchEvent({event}); }} 0"),
    );
    browser.wait(
        page,
        "(({ role, textContent }) => role === 'status' && textContent.startsWith('the model is shown'))(document.getElementById('notice'))",
    );
    let model =
        glint::model::of_file(name, mesh.into(), Options::default(), &mut |_| None).unwrap();
    let mut console = Console::new(board);
    glint::transfer::upload(&mut console, &model.mesh, None, 1, &mut |_, _| {}).unwrap();
    glint::transfer::show(&mut console, glint::transfer::MODEL, model.up).unwrap();
}

/// The screenshot of the page in the documentation.
fn documented() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/pictures/page.png")
}

/// With the environment variable `GLINT_UPDATE`, replaces the screenshot in the documentation.
#[test]
fn a_board_in_a_browser() {
    let served = Served::start("page-browser");
    let mut browser = Browser::start();
    let page = browser.open(&served.url);
    let mut board = exercise(&mut browser, &page);
    if std::env::var_os("GLINT_UPDATE").is_some() {
        browser.evaluate(&page, "scrollTo(0, 0)");
        std::fs::write(documented(), browser.picture(&page)).unwrap();
    }

    // A second page, on a narrow display, shows an identical picture, and cannot control the board.
    let second = browser.open(&served.url);
    browser.call(
        Some(&second),
        "Emulation.setDeviceMetricsOverride",
        serde_json::json!({ "width": 320, "height": 640, "deviceScaleFactor": 1, "mobile": true }),
    );
    browser.wait(&second, "document.documentElement.scrollWidth === 320");
    browser.wait(&second, "document.body.dataset.holder === 'other'");
    wait_for_picture(&mut browser, &second, &mut board);
    browser.wait(&second, "document.getElementById('line').disabled");
    browser.evaluate(&page, "document.getElementById('control').click()");
    browser.wait(&second, "document.body.dataset.holder === 'nobody'");
    browser.evaluate(&second, "document.getElementById('control').click()");
    browser.wait(&second, "document.body.dataset.holder === 'you'");
    browser.wait(&page, "document.getElementById('line').disabled");
}
