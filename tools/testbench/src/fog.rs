//! Drives the ports of the fog on triangles.

use glint_model::Fog;

use crate::Module;

/// Drives the port `fog` of a module, which has the type `triangle_registers_pkg::fog_t`.
pub fn drive_fog(module: &mut Module, fog: &Fog) {
    let [red, green, blue] = fog.colour;
    module.drive("fog.offset", fog.offset);
    module.drive("fog.colour", u32::from_le_bytes([red, green, blue, 0]));
}
