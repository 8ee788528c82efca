//! The scene of the wireframe simulator: its built-in program, and the board's buttons as its keys.

use glint_core::fixed::Q5_11;
use glint_core::wireframe::{Debouncer, Key, Opcode, Requests, WORD_BYTES};
use glint_hal::timer::Clock;

/// Name of the scene on the console.
pub const WIREFRAME: &str = "wireframe";

/// Switch 0: the arrows rotate instead of pan.
const ROTATE: u16 = 1 << 0;
/// Switch 1: the buttons up and down are the keys zoom-in and zoom-out.
const ZOOM: u16 = 1 << 1;

/// The keys of buttons 0 to 3.
const ARROWS: [Key; 4] = [Key::Up, Key::Down, Key::Left, Key::Right];

/// The buttons, and the requests of the keys.
#[derive(Default)]
pub struct Keypad {
    debouncer: Debouncer,
    requests: Requests,
}

impl Keypad {
    /// Takes a sample of all buttons, one bit each. Returns those whose press counts from now on, one bit each.
    pub fn sample(&mut self, buttons: u8, clock: Clock) -> u8 {
        // The time wraps after 49 days, which the debouncer allows.
        let now_ms = clock.milliseconds() as u32;
        self.debouncer.sample(now_ms, buttons)
    }

    /// Adds the requests of pressed buttons.
    pub fn press(&mut self, pressed: u8, switches: u16) {
        let zoom = switches & ZOOM != 0;
        for (button, key) in ARROWS.into_iter().enumerate() {
            let key = match key {
                Key::Up if zoom => Key::ZoomIn,
                Key::Down if zoom => Key::ZoomOut,
                key => key,
            };
            if pressed >> button & 1 != 0 {
                self.requests.press(key);
            }
        }
    }

    /// Takes the request for the next frame.
    pub fn take(&mut self) -> Option<Key> {
        self.requests.take()
    }

    /// Whether a request waits for a frame.
    pub const fn has_request(&self) -> bool {
        !self.requests.is_empty()
    }

    /// Whether a button's level is changing, so that the next sample should follow soon.
    pub const fn is_changing(&self) -> bool {
        self.debouncer.is_changing()
    }
}

/// Whether switch 0 selects rotation.
pub const fn rotates(switches: u16) -> bool {
    switches & ROTATE != 0
}

/// The built-in program: a cube of side 4 about the origin, seen from (0, 0, 8) through the window ±4 × ±2.25 at z = 4.
pub static PROGRAM: [[u8; WORD_BYTES]; 16] = program();

const fn program() -> [[u8; WORD_BYTES]; 16] {
    const fn q(decimal: &str) -> Q5_11 {
        Q5_11::lit(decimal)
    }
    const O: Q5_11 = Q5_11::ZERO;
    let mut words = [[0; WORD_BYTES]; 16];
    words[0] = word(Opcode::Eye, [O, O, q("8"), O, O, O]);
    words[1] = word(Opcode::Plane, [q("4"), O, O, O, O, O]);
    words[2] = word(
        Opcode::Window,
        [q("-4"), q("-2.25"), q("4"), q("2.25"), O, O],
    );
    let sides = [q("-2"), q("2")];
    let mut edge = 0;
    while edge < 12 {
        // Four edges along each axis, one for each pair of sides on the other two axes.
        let (axis, corner) = (edge / 4, edge % 4);
        let (first, second) = (sides[corner % 2], sides[corner / 2]);
        let [low, high] = sides;
        words[3 + edge] = word(
            Opcode::Segment,
            match axis {
                0 => [low, first, second, high, first, second],
                1 => [first, low, second, first, high, second],
                _ => [first, second, low, first, second, high],
            },
        );
        edge += 1;
    }
    words[15] = word(Opcode::End, [Q5_11::from_bits(-1); 6]);
    words
}

/// Encodes a word in a constant; [`glint_core::wireframe::Instruction::encode`] does so at run time.
const fn word(opcode: Opcode, fields: [Q5_11; 6]) -> [u8; WORD_BYTES] {
    let mut bits = opcode as u128;
    let mut field = 0;
    while field < fields.len() {
        bits = bits << 16 | fields[field].to_bits() as u16 as u128;
        field += 1;
    }
    bits.to_le_bytes()
}
