//! The argument of the command `projection`.

use super::argument::{Argument, Reader};
use super::error::ValueError;
use super::syntax::{Parameter, Shape, WordKind};
use crate::camera::{self, Sides, ViewVolume};
use crate::choice::choices;
use crate::fixed::{Q32_32, U4_28, U8_28};

/// The first word of the argument.
#[derive(Clone, Copy)]
enum Kind {
    Perspective,
    Orthographic,
    Matrix,
}

choices!(Kind {
    Perspective: "perspective",
    Orthographic: "orthographic",
    Matrix: "matrix",
});

/// The view volume, from its sides or from a matrix.
pub struct Projection;

static KIND: Parameter = Parameter::of::<Kind>("kind");
static LEFT: Parameter = Parameter::of::<Q32_32>("left");
static RIGHT: Parameter = Parameter::of::<Q32_32>("right");
static BOTTOM: Parameter = Parameter::of::<Q32_32>("bottom");
static TOP: Parameter = Parameter::of::<Q32_32>("top");
static NEAR: Parameter = Parameter::of::<U4_28>("near");
static FAR: Parameter = Parameter::of::<Option<U8_28>>("far");
static ENTRY: Parameter = Parameter::of::<Q32_32>("entry");

impl Argument for Projection {
    type Value<'a> = ViewVolume;
    const SHAPE: Shape = Shape::group(
        const {
            &[
                Parameter::of::<Kind>("kind"),
                Parameter {
                    name: "numbers",
                    optional: false,
                    shape: Shape::Word(&WordKind::Text(
                        &"LEFT RIGHT BOTTOM TOP NEAR [FAR], the sides of the picture in the near plane, and distances from the eye; after \
                          matrix 16 numbers, row by row, of a projection matrix of OpenGL",
                    )),
                },
            ]
        },
    );

    #[inline(never)]
    fn read<'a>(reader: &mut Reader<'a>, _: &'static Parameter) -> Option<ViewVolume> {
        let volume = match reader.read::<Kind>(&KIND)? {
            Kind::Perspective => of_sides(reader, camera::Projection::Perspective)?,
            Kind::Orthographic => of_sides(reader, camera::Projection::Orthographic)?,
            Kind::Matrix => {
                let mut matrix = [[Q32_32::ZERO; 4]; 4];
                for entry in matrix.as_flattened_mut() {
                    *entry = reader.read::<Q32_32>(&ENTRY)?;
                }
                ViewVolume::of_matrix(&matrix)
            }
        };
        volume
            .map_err(|error| reader.reject(ValueError::View(error)))
            .ok()
    }
}

/// Reads the sides, the near plane and, if the line does not end before it, the far plane.
fn of_sides(
    reader: &mut Reader,
    projection: camera::Projection,
) -> Option<Result<ViewVolume, camera::ViewError>> {
    let sides = Sides {
        left: reader.read::<Q32_32>(&LEFT)?,
        right: reader.read::<Q32_32>(&RIGHT)?,
        bottom: reader.read::<Q32_32>(&BOTTOM)?,
        top: reader.read::<Q32_32>(&TOP)?,
    };
    let near = reader.read::<U4_28>(&NEAR)?;
    let far = reader.read::<Option<U8_28>>(&FAR)?;
    Some(ViewVolume::of_sides(projection, sides, near, far))
}
