//! A repeated flight through the centre of a Menger sponge. The motion sensor turns the view; without a sensor, the buttons left and right
//! do. The buttons up and down change the speed.
#![cfg_attr(target_arch = "riscv32", no_std, no_main)]
#![deny(unsafe_code)]

use glint_program::core::camera::View;
use glint_program::core::field::Field;
use glint_program::core::fixed::{Q32_32, Turns, U4_28};
use glint_program::core::light::{Background, Material};
use glint_program::core::picture::Size;
use glint_program::core::quality::Quality;
use glint_program::scene::Sphere;
use glint_program::{Board, Button, Picture, PictureError, Program};

/// The flight follows the y axis from −`END` to `END`.
const END: Q32_32 = Q32_32::lit("1.8");
/// Largest speed in world units per second, and the change of the speed by one press of a button.
const FASTEST: Q32_32 = Q32_32::lit("1.5");
const FASTER: Q32_32 = Q32_32::lit("0.1");

struct Flight {
    field: Field,
    place: Q32_32,
    /// Direction of view in the horizontal plane, used without a sensor.
    yaw: Turns,
    speed: Q32_32,
    view: View,
}

impl Program for Flight {
    fn start(board: &mut Board) -> Self {
        board.log(format_args!(
            "flight: turn the sensor, or press left and right"
        ));
        let field = Field::parse("menger:3").expect("the field is valid");
        let mut flight = Self {
            field,
            place: -END,
            yaw: Turns(0),
            speed: Q32_32::lit("0.3"),
            view: Sphere::START.view().expect("the start camera is valid"),
        };
        flight.look(board);
        flight
    }

    fn update(&mut self, board: &mut Board) {
        // An eighth of a turn per second.
        let turned =
            Turns((u128::from(Turns::QUARTER.0) * board.step().as_micros() / 2_000_000) as u32);
        if board.is_held(Button::Right) {
            self.yaw = self.yaw.wrapping_add(turned);
        }
        if board.is_held(Button::Left) {
            self.yaw = self.yaw.wrapping_add(-turned);
        }
        if board.is_pressed(Button::Up) {
            self.speed = (self.speed + FASTER).min(FASTEST);
        }
        if board.is_pressed(Button::Down) {
            self.speed = (self.speed - FASTER).max(Q32_32::ZERO);
        }
        // Limits the step, so that a pause does not move the camera far.
        let seconds = Q32_32::from_num(board.step().as_micros().min(100_000) as u32) / 1_000_000;
        self.place += self.speed * seconds;
        if self.place > END {
            self.place -= END * 2;
        }
        self.look(board);
    }

    fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
        picture.view = self.view;
        picture.size = Size::W640;
        picture.appearance.material = Material::Jade;
        picture.appearance.background = Some(Background::Sky);
        picture.appearance.fog = U4_28::lit("0.25");
        picture.field(&self.field, Quality::Balanced)
    }
}

impl Flight {
    /// Sets the direction of view from the sensor or, without a sensor, from the buttons.
    fn look(&mut self, board: &Board) {
        // Not on the axis, so that the walls on both sides are at unequal distances.
        let eye = [Q32_32::lit("0.07"), self.place, Q32_32::lit("0.04")];
        let view = match board.motion() {
            Some(motion) => motion.view(eye),
            None => View::look(eye, self.yaw, Turns(0), Turns(0)),
        };
        self.view = view.unwrap_or(self.view);
    }
}

glint_program::run!(Flight);
