//! For every button that shows a scene, a mesh or a field, the commands succeed, and the picture
//! has more than one colour.

use crate::alone::Files;
use crate::browser::{Browser, Page};
use crate::served::Served;
use glint_core::field::KINDS;
use serde_json::Value;
use std::collections::HashMap;

/// Waits until the picture has not changed for 0.6 s, or until eight new pictures have been shown.
/// Returns the number of colours of the picture, the share of the most frequent colour, and a hash
/// of the picture.
const PICTURE: &str = "new Promise((done) => {
  const canvas = document.getElementById('monitor');
  const number0 = Number(canvas.dataset.number ?? 0);
  let [shown, since] = [number0, performance.now()];
  const look = () => {
    const now = performance.now();
    if (Number(canvas.dataset.number) !== shown) since = now;
    shown = Number(canvas.dataset.number);
    if (now - since < 600 && shown < number0 + 8) return setTimeout(look, 20);
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    const counts = new Map();
    let hash = 0;
    for (const colour of new Uint32Array(data.buffer)) {
      counts.set(colour, (counts.get(colour) ?? 0) + 1);
      hash = (hash * 31 + colour) | 0;
    }
    const share = Math.max(...counts.values()) / (canvas.width * canvas.height);
    done([counts.size, share, `${hash}`]);
  };
  look();
})";

/// Presses the button `number` of a list, waits for its picture, and checks console and picture.
/// Returns the button's text and a hash of the picture.
fn press(browser: &mut Browser, page: &Page, list: &str, number: usize) -> (String, String) {
    let log = "document.getElementById('log').textContent";
    let before = browser.evaluate(page, &format!("{log}.length"));
    let button = format!("document.querySelectorAll('#{list} button')[{number}]");
    let name = browser.evaluate(page, &format!("{button}.textContent"));
    let name = name.as_str().unwrap().to_owned();
    browser.evaluate(page, &format!("{button}.click()"));
    browser.wait(
        page,
        &format!("{log}.length > {before} && /(ok|error: .*)$/.test({log}.trimEnd())"),
    );
    // This command is executed after the commands of the button, so its reply follows the frame.
    let before_render = browser.evaluate(page, &format!("{log}.length"));
    browser.evaluate(page, "document.getElementById('line').focus()");
    browser.type_line(page, "render");
    browser.wait(
        page,
        &format!("/^clock [0-9]+$[^]*^ok$/m.test({log}.slice({before_render}))"),
    );
    let found = browser.evaluate(page, PICTURE);
    let text = browser.evaluate(page, &format!("{log}.slice({before})"));
    let text = text.as_str().unwrap();
    let [colours, share] = [0, 1].map(|index: usize| found[index].as_f64().unwrap());
    println!("{list} {name}: {colours} colours, {share:.3} of one");
    assert!(!text.contains("error:"), "{list} {name}: {text}");
    assert!(
        colours >= 2.0 && share < 0.995,
        "{list} {name}: a picture of one colour"
    );
    (name, found[2].as_str().unwrap().to_owned())
}

fn press_all(url: &str) {
    let mut browser = Browser::start();
    let page = browser.open(url);
    browser.wait(&page, "document.body.dataset.holder === 'you'");
    let count = |browser: &mut Browser, list: &str| {
        let buttons = format!("document.querySelectorAll('#{list} button').length");
        browser.wait(&page, &format!("{buttons} > 3"));
        browser.evaluate(&page, &buttons).as_u64().unwrap() as usize
    };
    // A scene requires the sensor, which starts later than the board.
    browser.wait(
        &page,
        "/yaw -?[0-9]/.test(document.querySelector('#curve-attitude figcaption').textContent)",
    );
    // A bent union, which the soft core draws, has no button.
    assert_eq!(count(&mut browser, "fields"), KINDS.len() - 1);
    let mut hashes = HashMap::new();
    for list in ["scenes", "meshes", "fields"] {
        for number in 0..count(&mut browser, list) {
            let (name, hash) = press(&mut browser, &page, list, number);
            if list != "scenes" {
                let other = hashes.insert(hash, name.clone());
                assert_eq!(other, None, "{name} has the picture of another button");
            }
        }
    }

    // A moving field moves until another choice is made or a command is entered.
    let moving = "[...document.querySelectorAll('#fields button')].find(({ textContent }) => textContent === 'moving')";
    browser.evaluate(&page, &format!("{moving}.click()"));
    let number = "Number(document.getElementById('monitor').dataset.number)";
    let before = browser.evaluate(&page, number);
    browser.wait(&page, &format!("{number} > {before} + 20"));
    browser.evaluate(&page, "document.getElementById('line').focus()");
    browser.type_line(&page, "echo still");
    browser.wait(
        &page,
        "/^still$/m.test(document.getElementById('log').textContent)",
    );
    let rest = "new Promise((done) => setTimeout(() => { const before = document.getElementById('monitor').dataset.number; \
        setTimeout(() => done(before === document.getElementById('monitor').dataset.number), 400); }, 200))";
    assert_eq!(browser.evaluate(&page, rest), Value::Bool(true));
}

#[test]
fn every_button_shows_a_picture() {
    press_all(&Served::start("page-buttons").url);
}

#[test]
fn every_button_shows_a_picture_without_a_program() {
    press_all(&Files::start().url);
}
