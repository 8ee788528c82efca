//! A torus that a hand in front of the image sensor rotates and moves: left and right, up and down, nearer and farther. Without a hand the
//! torus rotates at a constant rate.
#![cfg_attr(target_arch = "riscv32", no_std, no_main)]
#![deny(unsafe_code)]

use glint_program::core::camera::View;
use glint_program::core::fixed::{Q8_24, Q32_32, Turns};
use glint_program::core::matrix::Matrix;
use glint_program::core::mesh::Mesh;
use glint_program::core::picture::Size;
use glint_program::core::shape::Shape;
use glint_program::graphics::mono_font::ascii::FONT_9X18;
use glint_program::graphics::pixelcolor::{Rgb565, RgbColor};
use glint_program::{Board, Canvas, Hand, Picture, PictureError, Program};

/// The camera without a hand: distance from the origin, and angle from the z axis.
const DISTANCE: Q32_32 = Q32_32::lit("2.2");
const POLAR: Turns = Turns::from_degrees(Q32_32::lit("60"));
/// Scale of the mesh.
const SIZE: Q8_24 = Q8_24::lit("2");
const TURNS_A_SECOND: Q32_32 = Q32_32::lit("0.1");

struct Turner {
    mesh: Mesh<'static>,
    azimuth: Turns,
    hand: Option<Hand>,
}

impl Program for Turner {
    fn start(board: &mut Board) -> Self {
        board.watches_hand = true;
        Self {
            mesh: board.shape(Shape::Torus),
            azimuth: Turns(0),
            hand: None,
        }
    }

    fn update(&mut self, board: &mut Board) {
        self.azimuth = board.turns(TURNS_A_SECOND);
        self.hand = board.hand().copied();
        board.leds = u16::from(self.hand.is_some_and(|hand| hand.is_seen));
    }

    fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
        picture.size = Size::W640;
        picture.view = match self.hand {
            Some(Hand {
                pose,
                is_seen: true,
            }) => View::spherical(pose.r, pose.theta, pose.phi)?,
            _ => View::spherical(DISTANCE, self.azimuth, POLAR)?,
        };
        picture.mesh(self.mesh, Matrix::scale([SIZE; 3])?)?;
        Ok(())
    }

    fn paint(&self, canvas: &mut Canvas) {
        let state = match self.hand {
            None => "no image sensor on this board",
            Some(Hand { is_seen: false, .. }) => "show a hand to the camera",
            Some(_) => "the hand turns the torus",
        };
        canvas.text([12, 8], &FONT_9X18, Rgb565::WHITE, format_args!("{state}"));
    }
}

glint_program::run!(Turner);
