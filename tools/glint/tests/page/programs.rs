//! Programs and scenes on the page: by a button, by the page's address, and by a dropped file.

use crate::alone::Files;
use crate::browser::Browser;
use crate::page::wait_for_pixels;
use crate::served::Served;
use crate::upload::{drop_files, rendered, wait_for_notice};
use glint_board_api::built;
use litex_pac::BUILD_ID;

const LOG: &str = "document.getElementById('log').textContent";
const NOTICE: &str = "document.getElementById('notice').textContent";

/// The ELF file of an example.
fn elf(name: &str) -> Vec<u8> {
    let file = format!("firmware/programs/{name}.elf");
    std::fs::read(built::find(&file, "cargo xtask programs").unwrap()).unwrap()
}

#[test]
fn a_page_without_a_program_plays_the_examples_and_returns_to_the_firmware() {
    let files = Files::start();
    let mut browser = Browser::start();
    let page = browser.open(&format!("{}#program=fighter.bin", files.url));
    browser.wait(&page, &format!("{NOTICE}.startsWith('fighter.bin runs, ')"));
    browser.wait(
        &page,
        &format!("{LOG}.includes('fighter: fly through the gates')"),
    );
    browser.wait_for_light(&page, 500);
    browser.wait(&page, "document.getElementById('scenes').hidden");
    // The program's functions of the buttons are unknown.
    browser.wait(
        &page,
        "document.querySelector('#buttons button').title === 'up'",
    );

    let press = |name: &str| {
        format!(
            "[...document.querySelectorAll('#programs button')].find(({{ textContent }}) => textContent === '{name}').click()"
        )
    };
    browser.evaluate(&page, &press("kernel"));
    browser.wait(&page, &format!("{LOG}.includes('newton: ')"));
    browser.wait(&page, "location.hash === '#program=kernel.bin'");
    browser.evaluate(&page, &press("firmware"));
    browser.wait(
        &page,
        "document.querySelectorAll('#scenes button').length > 10",
    );
    browser.wait(&page, "!document.getElementById('scenes').hidden");

    // An address with a scene shows it, and names the choices if there is no such scene.
    let page = browser.open(&format!("{}#scene=wireframe", files.url));
    browser.wait(&page, &format!("{LOG}.includes('scene wireframe')"));
    let page = browser.open(&format!("{}#scene=nowhere", files.url));
    browser.wait(
        &page,
        &format!("{NOTICE}.startsWith('#scene=nowhere: expected one of ')"),
    );
    // So does an address with the text of a scene, which a dropped scene becomes.
    let scene = "title = 'A ring'\nmodel = 'torus'\ncamera = '2.5 30 60'\nsize = '320 180'\n";
    drop_files(&mut browser, &page, &[("ring.toml", scene.into())]);
    wait_for_notice(&mut browser, &page, "the scene ring.toml is shown");
    let address = browser.evaluate(&page, "location.href");
    let page = browser.open(address.as_str().unwrap());
    wait_for_notice(&mut browser, &page, "the scene link.toml is shown");
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ring.toml"), scene).unwrap();
    let shown = rendered(folder.path(), &["--scene", "ring.toml"]);
    wait_for_pixels(&mut browser, &page, &shown);

    let page = browser.open(&format!("{}#program=nothing.bin", files.url));
    browser.wait(
        &page,
        &format!("{NOTICE}.startsWith('nothing.bin: expected a file beside the page')"),
    );
}

#[test]
fn a_watched_program_starts_again_when_its_file_changes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hello.elf");
    std::fs::write(&path, elf("kernel")).unwrap();
    let file = path.to_str().unwrap();
    let served = Served::start_with("watch", &["--web", "--watch", "--firmware", file]);
    let mut browser = Browser::start();
    let page = browser.open(&served.url);
    // The next notice would otherwise replace the one that is expected.
    browser.wait(
        &page,
        &format!("{NOTICE}.startsWith('The program has no prompt')"),
    );
    std::fs::write(&path, b"no program\n").unwrap();
    browser.wait(
        &page,
        &format!("{NOTICE}.includes('expected a flat binary')"),
    );
    std::fs::write(&path, elf("fighter")).unwrap();
    browser.wait(&page, &format!("{NOTICE}.startsWith('hello.elf runs, ')"));
    browser.wait(&page, &format!("{LOG}.includes('fly through the gates')"));
}

#[test]
fn a_dropped_program_replaces_the_running_one_and_its_faults_are_shown() {
    let served = Served::start("programs");
    let mut browser = Browser::start();
    let page = browser.open(&served.url);
    browser.wait(
        &page,
        "document.querySelectorAll('#scenes button').length > 10",
    );
    drop_files(&mut browser, &page, &[("faults", elf("faults"))]);
    browser.wait(&page, &format!("{NOTICE}.startsWith('faults runs, ')"));
    for (starts, (switch, texts)) in (1..).zip([
        (0, ["panicked at ", "a fault on purpose"]),
        (2, ["stack overflow: ", " is in "]),
        (4, ["trap: illegal instruction", " is in update, "]),
        (1, ["no picture for 10 seconds", " is in update, "]),
    ]) {
        let start = "faults: switches 0 to 4";
        browser.wait(&page, &format!("{LOG}.split('{start}').length > {starts}"));
        let click = format!("document.querySelector('[aria-label=\"switch {switch}\"]').click()");
        browser.evaluate(&page, &click);
        for text in texts {
            browser.wait(&page, &format!("{LOG}.includes('{text}')"));
        }
        let halt = "press Enter to restart";
        browser.wait(&page, &format!("{LOG}.split('{halt}').length > {starts}"));
        browser.evaluate(&page, &click);
        browser.evaluate(&page, "document.getElementById('line').focus()");
        browser.type_line(&page, "");
    }

    // Programs for other boards are refused, and the next one runs.
    let mut unlinked = elf("cube");
    let mut other = unlinked.clone();
    let name = b"_windows_end\0";
    let at = unlinked.windows(name.len()).position(|part| part == name);
    unlinked[at.unwrap()] = b'x';
    let id = BUILD_ID.to_le_bytes();
    let starts: Vec<_> = (0..other.len() - 4)
        .filter(|&at| other[at..at + 4] == id)
        .collect();
    for at in starts {
        other[at] ^= 0xff;
    }
    let mut large = vec![0x13; 4];
    large.resize((7 << 20) + 1, 0);
    for (file, bytes, text) in [
        ("unlinked.elf", unlinked, "without the symbol _windows_end"),
        ("other.elf", other, "found a program for gateware "),
        (
            "large.bin",
            large,
            "longer than the program's part of main memory",
        ),
    ] {
        drop_files(&mut browser, &page, &[(file, bytes)]);
        browser.wait(&page, &format!("{NOTICE}.includes(\"{text}\")"));
    }
    drop_files(&mut browser, &page, &[("cube.elf", elf("cube"))]);
    browser.wait(&page, &format!("{NOTICE}.startsWith('cube.elf runs, ')"));
    browser.wait_for_light(&page, 1_000);
}
