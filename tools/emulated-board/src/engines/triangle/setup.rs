//! The parameters of a geometry pass of a mesh.

use glint_core::camera::Projection;
use glint_core::colour::Shading;
use glint_core::mesh::Rgb565;
use glint_core::picture::{Quarter, Size, Window};
use glint_model::{DepthScale, MeshLight, MeshSetup};
use litex_pac::register::Value;
use litex_pac::triangle::{DepthScale as DepthScaleRegister, Geometry, offset};

use crate::engines::parameters::Parameters;

/// Frame constants and options of a mesh.
pub struct Setup {
    pub frame: MeshSetup,
    pub light: MeshLight,
    pub cull: bool,
    pub shading: Shading,
    pub colour: Option<Rgb565>,
}

impl Setup {
    /// Reads the parameters. A shift, a near plane or an exponent out of the range of docs/formats/camera.md is clamped to the
    /// range, because no frame has such constants.
    pub fn new(flags: Geometry, parameters: &Parameters, size: Size) -> Self {
        let scale = DepthScaleRegister::from_bits(parameters.word(offset::DEPTH_SCALE));
        // A 4-bit number in two's complement.
        let exponent = i32::from(((scale.exponent() << 4) as i8) >> 4);
        let shift = parameters.unsigned(offset::SCALE_SHIFT, 5) as i32;
        let near = i64::from(parameters.unsigned(offset::NEAR_HIGH, 7)) << 32
            | i64::from(parameters.word(offset::NEAR_LOW));
        let mut frame = MeshSetup::default();
        let quarter = Quarter {
            is_right: flags.right(),
            is_lower: flags.lower(),
        };
        let window = Window {
            size,
            quarter: flags.quarter().then_some(quarter),
        };
        [frame.width, frame.height] = size.pixels();
        (frame.picture, frame.middle) = (window.picture(), window.middle());
        if flags.orthographic() {
            frame.projection = Projection::Orthographic;
            let exponent = exponent.max(-6);
            frame.scale_shift = (shift - 1 + exponent).clamp(6, 18) as u32;
            frame.depth.exponent = exponent;
            frame.near = near;
        } else {
            let exponent = exponent.clamp(-5, 5);
            frame.scale_shift = shift.clamp(6, 18) as u32;
            frame.depth.exponent = exponent;
            frame.near = near.max(1 << (40 - frame.scale_shift).max(30));
        }
        frame.depth = DepthScale {
            mantissa: scale.mantissa(),
            ..frame.depth
        };
        frame.u = parameters.row(offset::ROW_U0, 25);
        frame.v = parameters.row(offset::ROW_V0, 25);
        frame.n = parameters.row(offset::ROW_N0, 25);
        frame.translation = [
            [offset::TX_LOW, offset::TX_HIGH],
            [offset::TY_LOW, offset::TY_HIGH],
            [offset::TZ_LOW, offset::TZ_HIGH],
        ]
        .map(|[low, high]| parameters.wide(low, high, 12));
        frame.light = parameters.row(offset::LIGHT_0, 25);
        frame.mirrors = flags.mirror();
        frame.is_placed = true;
        let parts = |register| {
            [0, 9, 18].map(|first: u32| (parameters.word(register) >> first & 0x1FF) as u16)
        };
        Self {
            light: MeshLight {
                row: frame.light,
                forward: frame.n,
                colour: parts(offset::LIGHT_COLOUR),
                ambient: parts(offset::AMBIENT),
            },
            frame,
            cull: flags.cull(),
            shading: if flags.smooth() {
                Shading::Smooth
            } else {
                Shading::Flat
            },
            colour: flags
                .recolour()
                .then(|| Rgb565(parameters.unsigned(offset::COLOUR, 16) as u16)),
        }
    }
}
