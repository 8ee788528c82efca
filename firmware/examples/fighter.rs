//! A game: gates approach the ship, and the buttons steer it through them. Each gate scores a point. The third crash ends the game, and
//! button up restarts it. From the first gate on, the digits show the score in place of the rate of drawing.
#![cfg_attr(target_arch = "riscv32", no_std, no_main)]
#![deny(unsafe_code)]

use glint_program::core::fixed::Q5_11;
use glint_program::core::picture::Size;
use glint_program::core::wireframe::{Motion, Viewing, Window};
use glint_program::graphics::mono_font::ascii::FONT_10X20;
use glint_program::graphics::pixelcolor::{Rgb565, RgbColor};
use glint_program::lines::Lines;
use glint_program::{Board, Button, Canvas, Picture, PictureError, Program};

/// 1.0 in Q5.11.
const ONE: i32 = 1 << 11;
/// Number of gates, and the distance between two of them.
const GATES: usize = 4;
const APART: i32 = 3 * ONE;
/// The z coordinate of the ship, the largest magnitude of its x and y coordinates, and half the side of a gate.
const SHIP: i32 = 3 * ONE;
const REACH: i32 = 2 * ONE;
const GATE: i32 = ONE;
/// The axis and the direction in which each button moves the ship.
const MOVES: [(Button, usize, i32); 4] = [
    (Button::Right, 0, 1),
    (Button::Left, 0, -1),
    (Button::Up, 1, 1),
    (Button::Down, 1, -1),
];
const VIEWING: Viewing = Viewing {
    eye: [Q5_11::ZERO, Q5_11::ZERO, Q5_11::lit("8")],
    plane: Q5_11::lit("4"),
    window: Window {
        low: [Q5_11::lit("-4"), Q5_11::lit("-2.25")],
        high: [Q5_11::lit("4"), Q5_11::lit("2.25")],
    },
};

struct Fighter {
    ship: [i32; 2],
    /// The centre of each gate.
    gates: [[i32; 3]; GATES],
    lines: Lines<128>,
    score: u64,
    lives: u32,
    random: u32,
}

impl Fighter {
    /// A random number from −`limit` to `limit`, by xorshift.
    fn random(&mut self, limit: i32) -> i32 {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 17;
        self.random ^= self.random << 5;
        (self.random >> 8) as i32 % (2 * limit + 1) - limit
    }

    /// Adds the closed polygon with these `corners`.
    fn outline<const N: usize>(&mut self, corners: [[i32; 3]; N]) {
        // The game keeps positions in the range of Q5.11.
        let point = |corner: [i32; 3]| corner.map(|x| Q5_11::from_bits(x as i16));
        for i in 0..N {
            self.lines
                .add([corners[i], corners[(i + 1) % N]].map(point));
        }
    }

    /// Replaces the lines by those of the gates and of the ship.
    fn show(&mut self) {
        self.lines.clear();
        for [x, y, z] in self.gates {
            let corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]];
            for side in [GATE, GATE * 5 / 4] {
                self.outline(corners.map(|[a, b]| [x + a * side, y + b * side, z]));
            }
        }
        let ([x, y], wing, tip) = (self.ship, ONE / 3, SHIP - ONE);
        let top = [x, y + wing / 3, SHIP];
        self.outline([[x, y, tip], [x - wing, y, SHIP], top, [x + wing, y, SHIP]]);
        self.outline([[x, y, tip], top]);
    }
}

impl Program for Fighter {
    fn start(board: &mut Board) -> Self {
        board.log(format_args!("fighter: fly through the gates"));
        let mut game = Self {
            ship: [0; 2],
            gates: [1, 2, 3, 4].map(|i| [0, 0, -APART * i]),
            lines: Lines::new(VIEWING),
            score: 0,
            lives: 3,
            random: 0x1234_5678,
        };
        game.show();
        game
    }

    fn update(&mut self, board: &mut Board) {
        board.leds = (1 << self.lives) - 1;
        if self.lives == 0 {
            if board.is_pressed(Button::Up) {
                *self = Self::start(board);
            }
            return;
        }
        let milliseconds = board.step().as_millis().min(50) as i32;
        for (button, axis, sign) in MOVES {
            if board.is_held(button) {
                let step = sign * 4 * ONE * milliseconds / 1000;
                self.ship[axis] = (self.ship[axis] + step).clamp(-REACH, REACH);
            }
        }
        let speed = (3 * ONE + ONE / 4 * self.score.min(20) as i32) * milliseconds / 1000;
        for i in 0..GATES {
            self.gates[i][2] += speed;
            let [x, y, z] = self.gates[i];
            if z < SHIP || self.lives == 0 {
                continue;
            }
            if (self.ship[0] - x).abs() < GATE && (self.ship[1] - y).abs() < GATE {
                self.score += 1;
                board.show_number(self.score);
            } else {
                self.lives -= 1;
                let (score, lives) = (self.score, self.lives);
                board.log(format_args!("crash: score {score}, lives {lives}"));
            }
            let [x, y] = [self.random(REACH), self.random(ONE)];
            self.gates[i] = [x, y, z - GATES as i32 * APART];
        }
        self.show();
    }

    fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
        picture.size = Size::W640;
        picture.wireframe(self.lines.program()?, Motion::default().pose())
    }

    fn paint(&self, canvas: &mut Canvas) {
        let (colour, end) = match self.lives {
            0 => (Rgb565::RED, "  game over: press up"),
            _ => (Rgb565::GREEN, ""),
        };
        let text = format_args!("score {}  lives {}{end}", self.score, self.lives);
        canvas.text([12, 8], &FONT_10X20, colour, text);
    }
}

glint_program::run!(Fighter);
