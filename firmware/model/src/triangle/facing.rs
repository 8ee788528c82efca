//! The visible side of a triangle.

/// The visible side of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    /// Counter-clockwise on the screen: 2A < 0.
    Front,
    /// Clockwise: 2A > 0.
    Back,
}

impl Facing {
    /// Attributes of a triangle's vertices in clockwise order on the screen: a front face has 1 and 2 swapped.
    pub fn order<T>(self, [a, b, c]: [T; 3]) -> [T; 3] {
        match self {
            Self::Front => [a, c, b],
            Self::Back => [a, b, c],
        }
    }
}
