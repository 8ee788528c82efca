//! Test triangles in screen coordinates; a flat triangle's colour is its index.

use glint_core::colour::Rgb565;
use glint_model::ScreenVertex;
use glint_model::triangle::setup::{Bounds, Oriented, Setup};
use glint_model::triangle::shade::Lit;
use glint_model::triangle::vertex::GUARD;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

pub const SMALL: (u32, u32) = (320, 180);
pub const MIDDLE: (u32, u32) = (640, 360);
pub const LARGE: (u32, u32) = (1280, 720);
pub const LANES: usize = 8;

pub type Corners = [ScreenVertex; 3];

/// A triangle to draw. The colour of a flat triangle is its index.
pub struct Triangle {
    pub corners: Corners,
    pub setup: Setup,
    pub colour: Rgb565,
}

impl Triangle {
    /// Sets up a triangle; returns `None` if it has no area or is outside the picture.
    pub fn new(corners: Corners, (width, height): (u32, u32), number: usize) -> Option<Self> {
        let oriented = Oriented::new(corners)?;
        let bounds = Bounds::new(&oriented.vertices, width, height)?;
        Some(Self {
            corners,
            setup: Setup::new(&oriented, bounds),
            colour: Rgb565(u16::try_from(number).unwrap()),
        })
    }

    /// Returns the triangle for smooth shading with the light `lit` at its vertices.
    pub fn with_light(mut self, lit: &[Lit; 3]) -> Self {
        let oriented = Oriented::new(self.corners).unwrap();
        self.setup = Setup::smooth(&oriented, self.setup.bounds, lit);
        self
    }
}

/// Sets up and numbers the triangles that have an area and lie in the picture.
pub fn numbered(size: (u32, u32), all: impl IntoIterator<Item = Corners>) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    for corners in all {
        triangles.extend(Triangle::new(corners, size, triangles.len()));
    }
    triangles
}

/// Makes a vertex at a position in units of 1/256 pixel.
pub fn corner([x, y]: [i32; 2], w: u32) -> ScreenVertex {
    ScreenVertex { x, y, w }
}

/// Makes a triangle's corners from positions in pixels, with three different depths.
pub fn pixels(corners: [[f64; 2]; 3]) -> Corners {
    let mut w = 0;
    corners.map(|place| {
        w += 40_000 * 64;
        corner(place.map(|x| (256.0 * x).round() as i32), w)
    })
}

pub struct Random(pub Pcg64Mcg);

impl Random {
    pub fn new(seed: u128) -> Self {
        Self(Pcg64Mcg::new(seed << 1 | 1))
    }

    pub fn within(&mut self, low: i32, high: i32) -> i32 {
        self.0.random_range(low..=high)
    }

    pub fn depth(&mut self) -> u32 {
        match self.within(0, 9) {
            0 => 0,
            1 => ((1 << 18) - 4) * 64,
            _ => self.0.random_range(0..((1 << 18) - 4) * 64),
        }
    }

    pub fn lit(&mut self) -> Lit {
        let colour = [[0; 3], [255; 3], self.0.random()][self.within(0, 2) as usize];
        Lit::new(
            Rgb565::with_fractions(colour),
            [[256, self.within(0, 256) as u32][self.within(0, 1) as usize]; 3],
        )
    }

    pub fn anywhere(&mut self) -> ScreenVertex {
        let reach = GUARD + 128;
        corner([0; 2].map(|_| self.within(-reach, reach)), self.depth())
    }

    /// Makes a random vertex up to `reach` pixels from a position, in steps of `step`/256 pixel.
    pub fn near(&mut self, [x, y]: [i32; 2], reach: i32, step: i32) -> ScreenVertex {
        let reach = 256 * reach / step;
        let mut around = |c: i32| 256 * c + step * self.within(-reach, reach);
        let place = [around(x), around(y)];
        corner(place, self.depth())
    }

    /// Makes a random triangle of any size and shape.
    pub fn triangle(&mut self, (width, height): (u32, u32)) -> Corners {
        let (w, h) = (width as i32, height as i32);
        let place = [self.within(0, w), self.within(0, h)];
        match self.within(0, 9) {
            0 => [0; 3].map(|_| self.anywhere()),
            1 => [self.near(place, 80, 1), self.anywhere(), self.anywhere()],
            2 => [0; 3].map(|_| self.near(place, 100, 1)),
            3 | 4 => [0; 3].map(|_| self.near(place, 20, 1)),
            5 => [0; 3].map(|_| self.near(place, 2, 1)),
            6 => [0; 3].map(|_| self.near(place, 1, 16)),
            // Vertices on pixel centres and pixel edges, with some horizontal and vertical triangle edges.
            7 => [0; 3].map(|_| self.near(place, 12, 128)),
            8 => {
                let wide = [place[0] / 8 * 8, place[1]];
                [0; 3].map(|_| self.near(wide, 64, 8 * 256))
            }
            _ => {
                let (a, b) = (self.near(place, 200, 1), self.near(place, 200, 1));
                let middle = [(a.x + b.x) / 2 + self.within(-40, 40), (a.y + b.y) / 2];
                [a, b, corner(middle, self.depth())]
            }
        }
    }
}
