//! A built-in scene.

use glint_core::block::Block;

/// A built-in scene.
#[derive(Debug)]
pub struct BuiltIn {
    /// Name on the console.
    pub name: &'static str,
    /// The optional blocks of the gateware that it needs.
    pub blocks: &'static [Block],
    /// The console commands that set the picture and start what moves the camera, a line each, from the state at start on.
    pub lines: &'static str,
}

impl BuiltIn {
    /// The blocks that the scene needs and a gateware with these block enable bits lacks.
    pub fn lacks(&self, enabled: u32) -> impl Iterator<Item = Block> {
        let blocks = self.blocks.iter().copied();
        blocks.filter(move |block| block.bit() & !enabled != 0)
    }
}
