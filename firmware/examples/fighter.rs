//! A game: rings of stars come towards the ship; steer through the gaps with the buttons. Each gate that is passed is a point, the third
//! crash ends the game, and button up starts it again.
#![cfg_attr(target_arch = "riscv32", no_std, no_main)]
#![deny(unsafe_code)]

use glint_program::core::fixed::Q5_11;
use glint_program::core::wireframe::{Motion, Point, Viewing, Window};
use glint_program::graphics::mono_font::ascii::FONT_10X20;
use glint_program::graphics::pixelcolor::{Rgb565, RgbColor};
use glint_program::lines::Lines;
use glint_program::{Board, Button, Canvas, Picture, PictureError, Program};

/// Fraction bits of positions.
const ONE: i32 = 1 << 11;
/// Gates in flight, and the distance between them.
const GATES: usize = 4;
const APART: i32 = 3 * ONE;
/// Where a gate passes the ship, and where the farthest gate appears.
const SHIP: i32 = 3 * ONE;
/// Largest distance of the ship from the middle, and half of the side of a gate.
const REACH: i32 = 2 * ONE;
const GATE: i32 = ONE;
/// Crashes until the game ends.
const LIVES: u32 = 3;

struct Gate {
    /// Middle of the gate.
    middle: [i32; 2],
    z: i32,
}

struct Fighter {
    ship: [i32; 2],
    gates: [Gate; GATES],
    lines: Lines<128>,
    score: u64,
    lives: u32,
    random: u32,
    flash: u32,
}

fn point([x, y, z]: [i32; 3]) -> Point {
    [x, y, z].map(|x| Q5_11::from_bits(x.clamp(i16::MIN.into(), i16::MAX.into()) as i16))
}

impl Fighter {
    /// A random number from −`limit` to `limit`, by xorshift.
    fn random(&mut self, limit: i32) -> i32 {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 17;
        self.random ^= self.random << 5;
        (self.random >> 8) as i32 % (2 * limit + 1) - limit
    }

    /// Adds a closed line through `corners`, and whether it was added.
    fn outline<const N: usize>(&mut self, corners: [[i32; 3]; N]) -> bool {
        (0..N).all(|i| {
            let ends = [corners[i], corners[(i + 1) % N]];
            self.lines.add(ends.map(point))
        })
    }

    /// Writes gates and ship as lines.
    fn show(&mut self) {
        self.lines.clear();
        for i in 0..GATES {
            let Gate { middle: [x, y], z } = self.gates[i];
            let corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]];
            for side in [GATE, GATE * 5 / 4] {
                self.outline(corners.map(|[a, b]| [x + a * side, y + b * side, z]));
            }
        }
        let [x, y] = self.ship;
        let (wing, tip, tail) = (ONE / 3, SHIP - ONE, SHIP);
        self.outline([
            [x, y, tip],
            [x - wing, y, tail],
            [x, y + wing / 3, tail],
            [x + wing, y, tail],
        ]);
        self.outline([[x, y, tip], [x, y + wing / 3, tail]]);
    }
}

impl Program for Fighter {
    fn start(board: &mut Board) -> Self {
        board.log(format_args!("fighter: fly through the gates"));
        let [low, high] = [Q5_11::lit("-4"), Q5_11::lit("4")];
        let height = Q5_11::lit("2.25");
        let viewing = Viewing {
            eye: point([0, 0, 8 * ONE]),
            plane: Q5_11::lit("4"),
            window: Window {
                low: [low, -height],
                high: [high, height],
            },
        };
        let mut game = Self {
            ship: [0; 2],
            gates: [0, 1, 2, 3].map(|i| Gate {
                middle: [0; 2],
                z: -APART * (i + 1),
            }),
            lines: Lines::new(viewing),
            score: 0,
            lives: LIVES,
            random: 0x1234_5678,
            flash: 0,
        };
        game.show();
        game
    }

    fn update(&mut self, board: &mut Board) {
        board.show_number(self.score);
        board.leds = (1 << self.lives) - 1;
        self.flash = self.flash.saturating_sub(1);
        if self.lives == 0 {
            if board.is_pressed(Button::Up) {
                *self = Self::start(board);
            }
            return;
        }
        // Distance in a step of at most 50 ms; the speed rises with the score.
        let milliseconds = board.step().as_millis().min(50) as i32;
        let step = 4 * ONE * milliseconds / 1000;
        let moves = [
            (Button::Right, 0, 1),
            (Button::Left, 0, -1),
            (Button::Up, 1, 1),
            (Button::Down, 1, -1),
        ];
        for (button, axis, sign) in moves {
            if board.is_held(button) {
                self.ship[axis] = (self.ship[axis] + sign * step).clamp(-REACH, REACH);
            }
        }
        let speed = (3 * ONE + ONE / 4 * self.score.min(20) as i32) * milliseconds / 1000;
        for i in 0..GATES {
            self.gates[i].z += speed;
            if self.gates[i].z < SHIP {
                continue;
            }
            let Gate { middle: [x, y], z } = self.gates[i];
            let is_through = (self.ship[0] - x).abs() < GATE && (self.ship[1] - y).abs() < GATE;
            if is_through {
                self.score += 1;
            } else {
                self.lives -= 1;
                self.flash = 20;
                board.log(format_args!(
                    "crash, score {}, {} lives",
                    self.score, self.lives
                ));
            }
            let middle = [self.random(REACH), self.random(ONE)];
            self.gates[i] = Gate {
                middle,
                z: z - GATES as i32 * APART,
            };
            if self.lives == 0 {
                break;
            }
        }
        self.show();
    }

    fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
        picture.wireframe(self.lines.program()?, Motion::default().pose())
    }

    fn paint(&self, canvas: &mut Canvas) {
        let colour = if self.flash > 0 {
            Rgb565::RED
        } else {
            Rgb565::GREEN
        };
        let text = format_args!("score {}  lives {}", self.score, self.lives);
        canvas.text([12, 8], &FONT_10X20, colour, text);
        if self.lives == 0 {
            canvas.text(
                [12, 32],
                &FONT_10X20,
                Rgb565::RED,
                format_args!("game over: press up"),
            );
        }
    }
}

glint_program::run!(Fighter);
