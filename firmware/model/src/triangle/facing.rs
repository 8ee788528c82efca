//! The visible side of a triangle.

/// The visible side of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    /// Front face: counter-clockwise on the screen, so that its signed doubled area 2A is negative.
    Front,
    /// Back face: clockwise on the screen, so that its signed doubled area 2A is positive.
    Back,
}

impl Facing {
    /// Puts an attribute of the three vertices into clockwise order on the screen: for a front face, swaps the attributes
    /// of vertices 1 and 2.
    pub fn order<T>(self, [a, b, c]: [T; 3]) -> [T; 3] {
        match self {
            Self::Front => [a, c, b],
            Self::Back => [a, b, c],
        }
    }
}
