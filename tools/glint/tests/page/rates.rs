//! Measures the speed of the page: `cargo test --release -p glint --test page rates -- --ignored --nocapture`.

use crate::alone::Files;
use crate::browser::{Browser, Page};
use crate::served::Served;

/// Number of commands for which the time to the new picture is measured.
const KEYS: usize = 20;

/// A step that turns the sensor. 16 steps turn it by 20° to each side, so that the sponge stays in
/// view.
const TURN: &str = "const turn = steps % 16; const isLeft = turn < 5 || turn > 12; \
    dispatch(new KeyboardEvent('keydown', { key: turn === 0 ? 'Home' : isLeft ? 'ArrowLeft' : 'ArrowRight' }))";

/// A step that moves the hand on a circle.
const HAND: &str = "dispatch(new PointerEvent('pointermove', { buttons: 1, \
    clientX: box.x + box.width * (0.5 + 0.2 * Math.sin(performance.now() / 640)), \
    clientY: box.y + box.height * (0.5 + 0.2 * Math.cos(performance.now() / 640)) }))";

/// Measures how many pictures per second the board makes while `event` moves an element, and how
/// many the page has painted in the last second.
fn rate(browser: &mut Browser, page: &Page, element: &str, event: &str) -> String {
    let rate = browser.evaluate(
        page,
        &format!(
            "new Promise((done) => {{ const element = document.getElementById('{element}'); \
             const dispatch = (event) => element.dispatchEvent(event); let steps = 0, first = 0, start = 0; \
             const shown = () => Number(document.getElementById('monitor').dataset.number); \
             const step = () => {{ const box = element.getBoundingClientRect(); {event}; steps += 1; \
             if (steps === 150) [first, start] = [shown(), performance.now()]; \
             if (steps === 450) done([(shown() - first) * 1000 / (performance.now() - start), \
             parseInt(document.getElementById('rate').textContent) || 0]); else setTimeout(step, 20); }}; step(); }})"
        ),
    );
    let made = rate[0].as_f64().unwrap();
    format!(
        "{made:.1} pictures a second made by the board, {} painted",
        rate[1]
    )
}

/// The times in ms from pressing Enter in the console to the new picture, sorted.
fn key_times(browser: &mut Browser, page: &Page) -> Vec<f64> {
    let time = |number: usize| {
        let time = browser.evaluate(
            page,
            &format!(
                "new Promise((done) => {{ const canvas = document.getElementById('monitor'); const before = canvas.dataset.number; \
                 const line = document.getElementById('line'); line.value = 'camera 3 {} 60'; const start = performance.now(); \
                 document.getElementById('command').requestSubmit(); \
                 const look = () => canvas.dataset.number === before ? setTimeout(look, 1) : done(performance.now() - start); look(); }})",
                number * 10
            ),
        );
        time.as_f64().unwrap()
    };
    let mut times: Vec<f64> = (0..KEYS).map(time).collect();
    times.sort_by(f64::total_cmp);
    times
}

fn measure(name: &str, url: &str) {
    let mut browser = Browser::start();
    let page = browser.open(url);
    browser.wait(&page, "document.body.dataset.holder === 'you'");
    for (scene, element, event) in [
        ("holoforge", "hand", HAND),
        ("poor-mans-vr", "sensor", TURN),
    ] {
        for size in ["320 180", "640 360"] {
            browser.evaluate(&page, "document.getElementById('line').focus()");
            for line in [format!("scene {scene}"), format!("size {size}")] {
                browser.type_line(&page, &line);
            }
            let rate = rate(&mut browser, &page, element, event);
            println!("{name}, {scene} at {size}: {rate}");
        }
    }
    for line in ["imu off", "scene cube", "size 320 180"] {
        browser.type_line(&page, line);
    }
    let times = key_times(&mut browser, &page);
    let (median, longest) = (times[KEYS / 2], times[KEYS - 1]);
    println!("{name}, key to picture: median {median:.0} ms, longest {longest:.0} ms");
}

#[test]
#[ignore = "a measurement"]
fn rates() {
    measure("program", &Served::start("page-rates").url);
    measure("WebAssembly", &Files::start().url);
}
