//! The visible side of a triangle.

/// The scalar product of a normal (s2.14) and the camera's forward direction (s2.23); its magnitude is below 2^41.
pub fn along(normal: [i16; 3], n: &[i32; 3]) -> i64 {
    core::iter::zip(normal, n)
        .map(|(a, &b)| i64::from(a) * i64::from(b))
        .sum()
}

/// The visible side of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    /// Front face: counter-clockwise on the screen, so that the signed doubled area 2A is negative.
    Front,
    /// Back face: clockwise on the screen, so that the signed doubled area 2A is positive.
    Back,
}

impl Facing {
    /// Returns the opposite side.
    #[must_use]
    pub const fn opposite(self) -> Self {
        match self {
            Self::Front => Self::Back,
            Self::Back => Self::Front,
        }
    }

    /// The side of a surface with the normal `normal` that a camera with the forward direction `n` sees.
    pub fn of(normal: [i16; 3], n: &[i32; 3]) -> Self {
        if along(normal, n) <= 0 {
            Self::Front
        } else {
            Self::Back
        }
    }

    /// Sorts an attribute of the three vertices clockwise on the screen: for a front face, swaps the attributes of vertices 1 and 2.
    pub fn order<T>(self, [a, b, c]: [T; 3]) -> [T; 3] {
        match self {
            Self::Front => [a, c, b],
            Self::Back => [a, b, c],
        }
    }
}
