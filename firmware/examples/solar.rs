//! A sun with six planets, one of which has a moon. The buttons up and down change the speed of the animation, and left reverses its
//! direction.
#![cfg_attr(target_arch = "riscv32", no_std, no_main)]
#![deny(unsafe_code)]

use glint_program::core::camera::View;
use glint_program::core::colour::Rgb565;
use glint_program::core::fixed::{Q8_24, Q32_32, Turns};
use glint_program::core::light::{Background, Light, parse_rgb};
use glint_program::core::matrix::{Axis, Matrix, MatrixError};
use glint_program::core::mesh::Mesh;
use glint_program::core::shape::Shape;
use glint_program::graphics::mono_font::ascii::FONT_10X20;
use glint_program::graphics::pixelcolor::{Rgb565 as Colour, RgbColor};
use glint_program::{Board, Button, Canvas, Picture, PictureError, Program};

/// Radius of the orbit, diameter, turns per second, and colour.
type Planet = (Q8_24, Q8_24, Q32_32, &'static str);

const fn planet(orbit: &str, size: &str, turns: &str, colour: &'static str) -> Planet {
    (
        Q8_24::lit(orbit),
        Q8_24::lit(size),
        Q32_32::lit(turns),
        colour,
    )
}

const PLANETS: [Planet; 6] = [
    planet("0.75", "0.16", "0.40", "b0a090"),
    planet("1.00", "0.24", "0.25", "e8c070"),
    planet("1.30", "0.28", "0.16", "4080ff"),
    planet("1.60", "0.20", "0.10", "d05030"),
    planet("2.05", "0.60", "0.05", "d0a070"),
    planet("2.60", "0.48", "0.03", "e0d0a0"),
];
/// Index of the planet with the moon.
const EARTH: usize = 2;

struct Solar {
    sphere: Mesh<'static>,
    /// The angle of each planet, then the angle of the moon.
    angles: [Turns; PLANETS.len() + 1],
    /// Speed of the animation in units of 1/8.
    speed: i64,
}

/// The model matrix of a sphere of this size at this angle of an orbit.
fn placed(size: Q8_24, orbit: Q8_24, angle: Turns) -> Result<Matrix, MatrixError> {
    let zero = Q8_24::ZERO;
    Matrix::scale([size; 3])?
        .then(&Matrix::translation([orbit, zero, zero])?)?
        .then(&Matrix::rotation(Axis::Z, angle))
}

impl Program for Solar {
    fn start(board: &mut Board) -> Self {
        Self {
            sphere: board.shape(Shape::Sphere),
            // Multiples of the golden angle spread the planets around the sun.
            angles: core::array::from_fn(|i| Turns(0x61c8_8647_u32.wrapping_mul(i as u32))),
            speed: 8,
        }
    }

    fn update(&mut self, board: &mut Board) {
        if board.is_pressed(Button::Up) {
            self.speed = (self.speed * 2).clamp(-64, 64);
        }
        if board.is_pressed(Button::Down) {
            self.speed /= 2;
        }
        if board.is_pressed(Button::Left) {
            self.speed = if self.speed == 0 { 8 } else { -self.speed };
        }
        let rates = PLANETS.iter().map(|(_, _, rate, _)| *rate);
        let step = board.step().as_micros() as i64;
        for (angle, rate) in self
            .angles
            .iter_mut()
            .zip(rates.chain([Q32_32::lit("0.9")]))
        {
            let turned = i128::from(rate.to_bits()) * i128::from(step * self.speed) / 8_000_000;
            *angle = angle.wrapping_add(Turns(turned as u32));
        }
    }

    fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
        picture.view = View::spherical(
            Q32_32::lit("5"),
            Turns(0),
            Turns::from_degrees(Q32_32::lit("62")),
        )?
        .with_field_of_view(Turns::from_degrees(Q32_32::lit("76")))?;
        picture.appearance.background = Some(Background::Colour([4, 4, 12]));
        picture.appearance.ambient = Some([40; 3]);
        // A light has a direction, and no position, so it cannot come from the sun.
        let up = [Q32_32::ZERO, Q32_32::lit("0.5"), Q32_32::ONE];
        if let Ok(light) = Light::new(up, [0xff; 3]) {
            let _ = picture.appearance.lights.push(light);
        }
        let sun = placed(Q8_24::lit("0.9"), Q8_24::ZERO, Turns(0))?;
        self.ball(picture, sun, "ffe080")?;
        for (&(orbit, size, _, colour), &angle) in PLANETS.iter().zip(&self.angles) {
            self.ball(picture, placed(size, orbit, angle)?, colour)?;
        }
        let earth = placed(Q8_24::ONE, PLANETS[EARTH].0, self.angles[EARTH])?;
        let moon = placed(
            Q8_24::lit("0.09"),
            Q8_24::lit("0.27"),
            self.angles[PLANETS.len()],
        )?;
        self.ball(picture, moon.then(&earth)?, "c0c0c8")
    }

    fn paint(&self, canvas: &mut Canvas) {
        let (sign, speed) = (if self.speed < 0 { "-" } else { "" }, self.speed.abs());
        let text = format_args!("speed {sign}{}.{:03}", speed / 8, speed % 8 * 125);
        canvas.text([12, 8], &FONT_10X20, Colour::WHITE, text);
    }
}

impl Solar {
    fn ball<'p>(
        &'p self,
        picture: &mut Picture<'p>,
        place: Matrix,
        colour: &str,
    ) -> Result<(), PictureError> {
        let object = picture.mesh(self.sphere, place)?;
        object.colour = parse_rgb(colour).map(Rgb565::from_rgb888);
        Ok(())
    }
}

glint_program::run!(Solar);
