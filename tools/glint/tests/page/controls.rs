//! The page in use: completion of names, moving the camera with the mouse, sizes of controls on a
//! telephone, buttons by gamepad and fingers, and a picture at rest.

use crate::browser::{Browser, Page};
use crate::served::Served;
use serde_json::json;

/// Opens the page of a board, and waits until it shows its buttons and the sensor's attitude.
fn open(browser: &mut Browser, url: &str) -> Page {
    let page = browser.open(url);
    browser.wait(&page, "document.body.dataset.holder === 'you'");
    browser.wait(
        &page,
        "document.querySelectorAll('#scenes button').length > 3",
    );
    browser.wait(
        &page,
        "/yaw -?[0-9]/.test(document.querySelector('#curve-attitude figcaption').textContent)",
    );
    page
}

/// Emulates a display of this size in pixels.
fn resize(browser: &mut Browser, page: &Page, width: u32, height: u32, is_mobile: bool) {
    let size =
        json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": is_mobile });
    browser.call(Some(page), "Emulation.setDeviceMetricsOverride", size);
    browser.wait(page, &format!("innerWidth === {width}"));
}

/// Types a text, presses Tab, and waits for the line and a part of the hint.
fn complete(browser: &mut Browser, page: &Page, text: &str, line: &str, hint: &str) {
    browser.evaluate(page, "{ const line = document.getElementById('line'); line.focus(); line.value = ''; line.dispatchEvent(new Event('input')); }");
    browser.call(Some(page), "Input.insertText", json!({ "text": text }));
    browser.press(page, "Tab", "");
    browser.wait(
        page,
        &format!(
            "document.getElementById('line').value === '{line}' && document.getElementById('hint').textContent.includes('{hint}')"
        ),
    );
    let focus = browser.evaluate(page, "document.activeElement.id");
    assert_eq!(focus, "line", "{text}");
}

#[test]
fn names_are_completed_and_tab_stays_while_there_are_some() {
    let served = Served::start("page-completion");
    let mut browser = Browser::start();
    let page = open(&mut browser, &served.url);
    for (text, line, hint) in [
        ("scene pol", "scene polygons ", "scene"),
        ("scene m", "scene me", ""),
        ("scene me", "scene me", "menger  mesh-in-field"),
        ("object add cy", "object add cylinder ", "object"),
        ("field oct", "field octahedron:", "field"),
        ("edges ", "edges ", "off  hidden  over"),
    ] {
        complete(&mut browser, &page, text, line, hint);
        // A second Tab does not leave the line either.
        browser.press(&page, "Tab", "");
        let focus = browser.evaluate(&page, "document.activeElement.id");
        assert_eq!(focus, "line", "{text}");
    }
    complete(&mut browser, &page, "scene x", "scene x", "No completion");
    browser.press(&page, "Tab", "");
    browser.wait(&page, "document.activeElement.id === 'interrupt'");
}

#[test]
fn the_tour_explains_the_parts_and_shows_scenes() {
    let served = Served::start("page-tour");
    let mut browser = Browser::start();
    let page = open(&mut browser, &served.url);
    let click = |id: &str| format!("document.getElementById('{id}').click()");
    browser.evaluate(&page, &click("start-tour"));
    // A page of this machine offers no programs, so one of the eight parts is left out.
    let mut parts = Vec::new();
    for number in 1..=7 {
        let place =
            format!("document.getElementById('tour-place').textContent === '{number} of 7'");
        browser.wait(&page, &place);
        let part = "document.querySelector('.toured')";
        let is_seen = format!(
            "(({{ top, bottom }}) => bottom > 0 && top < innerHeight)({part}.getBoundingClientRect())"
        );
        assert_eq!(browser.evaluate(&page, &is_seen), true, "part {number}");
        parts.push(browser.evaluate(&page, &format!("{part}.id")));
        if number < 7 {
            browser.evaluate(&page, &click("tour-next"));
        }
    }
    let expected = [
        "screen", "scenes", "fields", "model", "command", "motion", "curves",
    ];
    assert_eq!(parts, expected);
    let log = "document.getElementById('log').textContent";
    browser.wait(&page, &format!("{log}.includes('scene menger')"));
    browser.evaluate(&page, &click("tour-back"));
    browser.wait(&page, "document.querySelector('.toured').id === 'motion'");
    browser.press(&page, "Escape", "");
    browser.wait(
        &page,
        "!document.getElementById('tour').open && !document.querySelector('.toured') && document.activeElement.id === 'start-tour'",
    );
}

#[test]
fn the_mouse_moves_the_camera() {
    let served = Served::start("page-orbit");
    let mut browser = Browser::start();
    let page = open(&mut browser, &served.url);
    let number = "Number(document.getElementById('monitor').dataset.number)";
    let log = "document.getElementById('log').textContent";
    // Returns the eye of the board's camera after an action, from the reply `view EX EY EZ ...`.
    let view_after = |browser: &mut Browser, action: &str, mark: &str| -> [f64; 3] {
        let enter = |line| format!("enter('{line}');");
        let lines = ["view", &format!("echo {mark}")].map(enter).concat();
        browser.evaluate(
            &page,
            &format!(
                "{{ const enter = (line) => {{ document.getElementById('line').value = line; document.getElementById('command').requestSubmit(); }}; {action} {lines} }}"
            ),
        );
        browser.wait(&page, &format!("/^{mark}$/m.test({log})"));
        let eye = browser.evaluate(
            &page,
            &format!(
                "[...{log}.matchAll(/^view (.*)$/gm)].at(-1)[1].split(' ').slice(0, 3).map(Number)"
            ),
        );
        [0, 1, 2].map(|axis| eye[axis].as_f64().unwrap())
    };
    let view = |browser: &mut Browser, mark: &str| view_after(browser, "", mark);
    let length = |eye: [f64; 3]| eye.iter().map(|c| c * c).sum::<f64>().sqrt();
    // A sensor that steered before does not move the camera any more.
    browser.evaluate(&page, "document.getElementById('line').focus()");
    // An empty line changes nothing.
    browser.type_line(&page, "");
    browser.type_line(&page, "scene default");
    browser.type_line(&page, "imu orbit");
    let first = view(&mut browser, "first");

    let middle = browser.middle(&page, "#monitor");
    let before = browser.evaluate(&page, number);
    browser.mouse(&page, "mousePressed", middle);
    for step in 1..=5 {
        let place = [middle[0] + 20.0 * f64::from(step), middle[1]];
        browser.mouse(&page, "mouseMoved", place);
    }
    browser.mouse(&page, "mouseReleased", [middle[0] + 100.0, middle[1]]);
    browser.wait(&page, &format!("{number} > {before}"));
    let turned = view(&mut browser, "turned");
    assert!((length(turned) - length(first)).abs() < 0.01);
    assert!((turned[2] - first[2]).abs() < 0.01, "{first:?} {turned:?}");
    let azimuth = |eye: [f64; 3]| eye[1].atan2(eye[0]);
    let angle = (azimuth(first) - azimuth(turned)).rem_euclid(std::f64::consts::TAU);
    assert!((0.2..1.0).contains(&angle), "{first:?} {turned:?}");

    let before = browser.evaluate(&page, number);
    let wheel =
        json!({ "type": "mouseWheel", "x": middle[0], "y": middle[1], "deltaX": 0, "deltaY": 200 });
    browser.call(Some(&page), "Input.dispatchMouseEvent", wheel);
    browser.wait(&page, &format!("{number} > {before}"));
    let away = view(&mut browser, "away");
    assert!(length(away) > 1.15 * length(turned), "{turned:?} {away:?}");

    // A pinch of two fingers zooms out, and one finger turns the camera.
    let touch = |browser: &mut Browser, kind: &str, places: &[[f64; 2]]| {
        let points: Vec<_> = places
            .iter()
            .enumerate()
            .map(|(id, [x, y])| json!({ "x": x, "y": y, "id": id }))
            .collect();
        let event = json!({ "type": kind, "touchPoints": points });
        browser.call(Some(&page), "Input.dispatchTouchEvent", event);
    };
    let at = |x: f64| [middle[0] + x, middle[1]];
    let before = browser.evaluate(&page, number);
    touch(&mut browser, "touchStart", &[at(-50.0), at(50.0)]);
    touch(&mut browser, "touchMove", &[at(-80.0), at(80.0)]);
    touch(&mut browser, "touchEnd", &[]);
    browser.wait(&page, &format!("{number} > {before}"));
    let near = view(&mut browser, "near");
    assert!(length(near) < 0.8 * length(away), "{away:?} {near:?}");

    // Opposite keys undo each other's steps.
    browser.evaluate(&page, "document.getElementById('monitor').focus()");
    for key in ["ArrowLeft", "+", "-", "ArrowRight"] {
        browser.press(&page, key, "");
    }
    let same = view(&mut browser, "same");
    assert!(
        (0..3).all(|i| (same[i] - near[i]).abs() < 0.01),
        "{near:?} {same:?}"
    );

    // A command is executed after the motion that was requested before it, here half a turn.
    let turn = "for (let step = 0; step < 36; step++) document.getElementById('monitor').dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowLeft' }));";
    let behind = view_after(&mut browser, turn, "behind");
    assert!(
        (0..2).all(|i| (behind[i] + same[i]).abs() < 0.01),
        "{same:?} {behind:?}"
    );
}

/// On a telephone the picture stays visible when the page is scrolled, and every control is at
/// least 24 pixels wide and high.
#[test]
fn a_telephone_shows_picture_and_controls() {
    let served = Served::start("page-telephone");
    let mut browser = Browser::start();
    let page = open(&mut browser, &served.url);
    let controls = "[...document.querySelectorAll('button, input, [tabindex]')].filter((control) => control.checkVisibility())";
    for (width, height, is_mobile) in [
        (1280, 900, false),
        (390, 844, true),
        (320, 640, true),
        (844, 390, true),
    ] {
        resize(&mut browser, &page, width, height, is_mobile);
        browser.wait(
            &page,
            &format!("document.documentElement.scrollWidth <= {width}"),
        );
        let small = browser.evaluate(
            &page,
            &format!(
                "{controls}.map((control) => [control.ariaLabel ?? control.id ?? control.textContent, control.getBoundingClientRect()]) \
                 .filter(([, {{ width, height }}]) => width < 24 || height < 24).map(([name, {{ width, height }}]) => `${{name}} ${{width}}×${{height}}`)"
            ),
        );
        assert_eq!(small, json!([]), "{width}×{height}");
        if !is_mobile {
            continue;
        }
        for target in [
            "#fields button:last-of-type",
            "#meshes button",
            "#model button",
        ] {
            browser.middle(&page, target);
            let seen = browser.evaluate(
                &page,
                "(() => { const { top, bottom, height } = document.getElementById('monitor').getBoundingClientRect(); \
                 return height > 100 && top >= 0 && bottom <= 0.6 * innerHeight; })()",
            );
            assert_eq!(seen, json!(true), "{target} at {width}×{height}");
            // The control in focus is not hidden by the picture.
            let is_free = browser.evaluate(
                &page,
                &format!(
                    "(() => {{ const control = document.querySelector('{target}'); const box = control.getBoundingClientRect(); \
                     return document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2) === control; }})()"
                ),
            );
            assert_eq!(is_free, json!(true), "{target} at {width}×{height}");
        }
    }
}

/// A button that is pressed with Shift stays pressed until its next press, with or without Shift.
#[test]
fn shift_keeps_a_button_pressed() {
    let served = Served::start("page-shift");
    let mut browser = Browser::start();
    let page = open(&mut browser, &served.url);
    let pressed = "[...document.querySelectorAll('[aria-pressed=true]')].map((button) => button.textContent).join()";
    let key = |name: &str, button: u8, shift: bool| {
        let (name, repeat) = match name {
            "repeat" => ("keydown", true),
            _ => (name, false),
        };
        format!(
            "document.querySelectorAll('#buttons button')[{button}].dispatchEvent(new KeyboardEvent('{name}', {{ key: ' ', shiftKey: {shift}, repeat: {repeat} }}))"
        )
    };
    for (name, button, shift, expected) in [
        ("keydown", 2, true, "BTN2"),
        ("keyup", 2, true, "BTN2"),
        ("blur", 2, false, "BTN2"),
        ("keydown", 3, false, "BTN2,BTN3"),
        ("keyup", 3, false, "BTN2"),
        ("keydown", 2, false, "BTN2"),
        ("keyup", 2, false, ""),
        ("keydown", 1, true, "BTN1"),
        ("repeat", 1, true, "BTN1"),
        ("keyup", 1, true, "BTN1"),
        ("keydown", 1, true, "BTN1"),
        ("keyup", 1, true, ""),
    ] {
        browser.evaluate(&page, &key(name, button, shift));
        browser.wait(&page, &format!("{pressed} === '{expected}'"));
    }
}

/// The page marks a picture at rest as `still`, and the curves of a sensor at rest are flat.
#[test]
fn rest_looks_like_rest() {
    let served = Served::start("page-rest");
    let mut browser = Browser::start();
    let page = open(&mut browser, &served.url);
    let rate = "document.getElementById('rate').textContent";
    browser.wait(&page, &format!("{rate} === 'still'"));
    // The sensor is at rest, so angles stay near 0. No angle may be shown as a negative zero.
    let caption = "document.querySelector('#curve-attitude figcaption').textContent";
    for _ in 0..20 {
        let text = browser.evaluate(
            &page,
            &format!("new Promise((done) => setTimeout(() => done({caption}), 100))"),
        );
        let text = text.as_str().unwrap();
        assert!(!text.contains("-0.0"), "{text}");
    }
    // The range of pixel rows that the curves use.
    let rows = browser.evaluate(
        &page,
        "(() => { const canvas = document.querySelector('#curve-attitude canvas'); const { width, height } = canvas; \
         const { data } = canvas.getContext('2d').getImageData(0, 0, width, height); \
         const rows = [...Array(height).keys()].filter((row) => data.subarray(4 * width * row, 4 * width * (row + 1)).some((part) => part > 0)); \
         return rows.at(-1) - rows[0]; })()",
    );
    assert!(rows.as_f64().unwrap() < 20.0, "{rows} of 60 rows");
    browser.evaluate(&page, "document.getElementById('line').focus()");
    browser.type_line(&page, "orbit 60");
    browser.wait(&page, &format!("/^[0-9]+ pictures\\/s$/.test({rate})"));
    browser.wait(&page, &format!("{rate} === 'still'"));
}

/// A gamepad presses the buttons, and in full screen two fingers do.
#[test]
fn a_gamepad_and_fingers_press_the_buttons() {
    let served = Served::start("page-buttons");
    let mut browser = Browser::start();
    let pad = "globalThis.pad = { buttons: Array.from({ length: 16 }, () => ({ pressed: false })), axes: [0, 0] }; \
        navigator.getGamepads = () => [null, pad];";
    let page = browser.open_with(&served.url, pad);
    browser.wait(&page, "document.body.dataset.holder === 'you'");
    // The board, not the page, reports which buttons are down.
    let wait = |browser: &mut Browser, buttons: &str| {
        let down = "[...document.querySelectorAll('#buttons [aria-pressed=true]')].map(({ textContent }) => textContent)";
        browser.wait(&page, &format!("{down}.join(' ') === '{buttons}'"));
    };
    for (change, buttons) in [
        (
            "pad.buttons[14].pressed = true; dispatchEvent(new Event('gamepadconnected'))",
            "BTN2",
        ),
        ("pad.axes = [0.2, -0.9]", "BTN0 BTN2"),
        ("pad.buttons[14].pressed = false", "BTN0"),
        ("pad.axes = [1, 1]", "BTN1 BTN3"),
        ("pad.axes = [0, 0]", ""),
    ] {
        browser.evaluate(&page, &format!("{change}; 0"));
        wait(&mut browser, buttons);
    }
    let title = "document.querySelector('#buttons button').title";
    browser.wait(&page, &format!("{title} === 'up: fire 1'"));

    let fingers = json!({ "enabled": true, "maxTouchPoints": 2 });
    browser.call(Some(&page), "Emulation.setTouchEmulationEnabled", fingers);
    let full = browser.middle(&page, "#full");
    for kind in ["mousePressed", "mouseReleased"] {
        browser.mouse(&page, kind, full);
    }
    browser.wait(&page, "document.fullscreenElement?.id === 'screen'");
    browser.wait(
        &page,
        "document.querySelector('#screen #buttons button').checkVisibility()",
    );
    let [left, right] =
        [2, 4].map(|place| browser.middle(&page, &format!("#buttons button:nth-of-type({place})")));
    for (kind, points) in [
        ("touchStart", vec![left]),
        ("touchStart", vec![left, right]),
        ("touchEnd", vec![]),
    ] {
        let points: Vec<_> = (points.iter().enumerate())
            .map(|(id, [x, y])| json!({ "x": x, "y": y, "id": id }))
            .collect();
        let buttons = ["", "BTN1", "BTN1 BTN3"][points.len()];
        let event = json!({ "type": kind, "touchPoints": points });
        browser.call(Some(&page), "Input.dispatchTouchEvent", event);
        wait(&mut browser, buttons);
    }
    browser.evaluate(&page, "document.exitFullscreen()");
    browser.wait(
        &page,
        "document.querySelector('#panel > #buttons + #motion') !== null",
    );
}
