//! Drives the ports of the sky behind triangles.

use glint_model::Sky;

use crate::Module;

/// Drives the port `sky` of a module, which has the type `triangle_registers_pkg::sky_t`.
pub fn drive_sky(module: &mut Module, sky: &Sky) {
    for (name, value) in [
        ("above", sky.above),
        ("across", sky.across),
        ("down", sky.down),
    ] {
        module.drive(&format!("sky.{name}"), value);
    }
    for (name, [red, green, blue]) in [
        ("zenith", sky.zenith),
        ("horizon", sky.horizon),
        ("nadir", sky.nadir),
    ] {
        let colour = u32::from_le_bytes([red, green, blue, 0]);
        module.drive(&format!("sky.{name}"), colour);
    }
}
