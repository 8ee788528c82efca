//! A rotating textured crate, which stops while button 0 is held.
#![cfg_attr(target_arch = "riscv32", no_std, no_main)]
#![deny(unsafe_code)]

use glint_program::core::camera::View;
use glint_program::core::fixed::{Q8_24, Q32_32, Turns};
use glint_program::core::matrix::{Axis, Matrix};
use glint_program::core::mesh::Mesh;
use glint_program::core::shape::Shape;
use glint_program::{Board, Button, Picture, PictureError, Program};

/// The camera: distance from the origin, azimuth, and angle from the z axis.
const PLACE: (Q32_32, Turns, Turns) = (
    Q32_32::lit("2.2"),
    Turns::from_degrees(Q32_32::lit("30")),
    Turns::from_degrees(Q32_32::lit("65")),
);
/// Scale of the mesh.
const SIZE: Q8_24 = Q8_24::lit("1.3");
/// One turn in six seconds.
const TURNS_A_SECOND: Q32_32 = Q32_32::lit("0.1666666667");

struct Cube {
    mesh: Mesh<'static>,
    angle: Turns,
}

impl Program for Cube {
    fn start(board: &mut Board) -> Self {
        board.log(format_args!("cube: hold button 0 to stop it"));
        Self {
            mesh: board.shape(Shape::Crate),
            angle: Turns(0),
        }
    }

    fn update(&mut self, board: &mut Board) {
        if !board.is_held(Button::Up) {
            self.angle = board.turns(TURNS_A_SECOND);
        }
    }

    fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
        let (distance, azimuth, polar) = PLACE;
        picture.view = View::spherical(distance, azimuth, polar)?;
        let size = Matrix::scale([SIZE; 3])?;
        picture.mesh(self.mesh, size.turned(Axis::Z, self.angle)?)?;
        Ok(())
    }
}

glint_program::run!(Cube);
