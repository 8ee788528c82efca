//! Objects: meshes with a position in the world (docs/formats/camera.md, "Objects").

use glint_core::camera::{Projection, View};
use glint_core::fixed::{Q8_24, U4_28, U8_28};
use glint_core::matrix::{Matrix, Normals};

use crate::error::RenderError;
use crate::triangle::mesh_setup::MeshSetup;
use crate::triangle::volume::Volume;

/// The smallest scale shift: with fewer fraction bits the products of the clipper do not fit 64 bits.
const LEAST_SHIFT: u32 = 7;

/// A model matrix, and values derived from it that do not depend on the camera.
// The order of the fields puts those that the soft core reads in each frame into few lines of its data cache.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placement {
    matrix: Matrix,
    /// The columns of the rotation or reflection that the matrix contains, without the scale, 24 fraction bits; the identity if normals are
    /// transformed.
    rotation: [[i32; 3]; 3],
    /// Upper bound of the length of a transformed unit vector, 24 fraction bits: the scale, if the matrix scales uniformly, otherwise the
    /// square root of the sum of the squares of all entries.
    stretch: u32,
    /// Whether the normals are transformed to world coordinates, or the mesh already has such normals; the light is then not rotated.
    in_world: bool,
    /// The matrix that transforms normals; `None` if normals are not transformed.
    normals: Option<Normals>,
}

impl Placement {
    /// Derives the values of a placement from a model matrix.
    #[inline(never)]
    pub fn new(matrix: Matrix) -> Self {
        const ONE: i32 = 1 << 24;
        let entries = matrix.linear().map(|row| row.map(Q8_24::to_bits));
        let square = |row: [i32; 3]| row.iter().map(|&x| i64::from(x).pow(2)).sum::<i64>();
        let [a, b, c] = entries.map(square);
        let normals = matrix.normals();
        let (kept, rotation, squared) = match normals.rotation() {
            // The squared lengths of the rows differ from that of the first row by a relative 2^−12 at most.
            Some(rotation) => (
                None,
                transposed(rotation.map(|row| row.map(|x| (x + (1 << 5)) >> 6))),
                a.max(b).max(c),
            ),
            None => (
                Some(normals),
                [[ONE, 0, 0], [0, ONE, 0], [0, 0, ONE]],
                a + b + c,
            ),
        };
        // At most 2^28·3, because there are nine entries.
        let root = squared.unsigned_abs().isqrt();
        Self {
            matrix,
            rotation,
            stretch: root as u32 + u32::from(root * root < squared.unsigned_abs()),
            in_world: kept.is_some(),
            normals: kept,
        }
    }

    /// The model matrix of the placement.
    pub const fn matrix(&self) -> &Matrix {
        &self.matrix
    }

    /// The matrix that transforms the normals of the mesh to world coordinates; `None` if the light is rotated instead, or if the mesh
    /// already has transformed normals.
    pub const fn normals(&self) -> Option<&Normals> {
        self.normals.as_ref()
    }

    /// Returns the placement for a copy of the mesh whose normals have been transformed by [`normals`](Self::normals), if any. The picture
    /// of the copy is bit-identical.
    #[must_use]
    pub const fn of_turned_mesh(&self) -> Self {
        Self {
            normals: None,
            ..*self
        }
    }

    /// Whether the mesh is lit in world coordinates: its normals are transformed, or are already in world coordinates.
    pub const fn has_normals_in_world(&self) -> bool {
        self.in_world
    }

    /// Returns the largest distance of a vertex from the origin of a mesh with the given `radius` (14 fraction bits), in world
    /// units with 38 fraction bits; below 2^46.
    fn reach(&self, radius: u32) -> i64 {
        (u64::from(radius) * u64::from(self.stretch)) as i64
    }

    /// Returns the smallest and the largest depth of a mesh with this placement, with 37 fraction bits. `camera` has the frame constants of
    /// the camera. The length of the axis n may be 1 + 10^−4, so the radius is multiplied by 1 + 2^−13.
    #[inline(always)]
    pub fn depths(&self, camera: &MeshSetup, radius: u32) -> [i64; 2] {
        let place = self.matrix.place().map(Q8_24::to_bits);
        let z = camera.depth_of_world() + nearest_10(dot(&camera.n, &place));
        let reach = self.reach(radius);
        let reach = (reach >> 1) + (reach >> 14) + 2;
        [z - reach, z + reach]
    }

    /// Computes the frame constants of a mesh with this placement from the constants of the camera, whose depth scale is used for all
    /// objects of a frame.
    ///
    /// All homogeneous coordinates are multiplied by 2^−k, with the smallest k for which the row n and the farthest vertex fit the formats
    /// of the vertex stage. The factor does not change screen positions and depth codes. In orthographic projection only Z is multiplied,
    /// because X and Y are not divided by a homogeneous coordinate.
    ///
    /// # Errors
    /// [`RenderError::Near`] if the near plane is too near for the size and the distance of the object;
    /// [`RenderError::Width`] if the view of an orthographic camera is too narrow for the object.
    pub fn setup(
        &self,
        view: &View,
        camera: &MeshSetup,
        radius: u32,
    ) -> Result<MeshSetup, RenderError> {
        let mut setup = *camera;
        self.update(&mut setup, view, camera, radius)?;
        Ok(setup)
    }

    /// Computes the frame constants as [`setup`](Self::setup) does, in place, because copying them is slow on the soft core. `setup` must
    /// hold the constants of the camera, or of another object with the same camera, and the volume in the camera's units.
    ///
    /// # Errors
    /// As [`setup`](Self::setup); `setup` must then not be used.
    #[inline(always)]
    pub fn update(
        &self,
        setup: &mut MeshSetup,
        view: &View,
        camera: &MeshSetup,
        radius: u32,
    ) -> Result<(), RenderError> {
        // The columns and the position stay in registers during the products with all rows.
        let [[ax, bx, cx], [ay, by, cy], [az, bz, cz]] = self.matrix.linear();
        let [x, y, z] = self.matrix.place();
        let (a, b, c, place) = (
            [ax.to_bits(), ay.to_bits(), az.to_bits()],
            [bx.to_bits(), by.to_bits(), bz.to_bits()],
            [cx.to_bits(), cy.to_bits(), cz.to_bits()],
            [x.to_bits(), y.to_bits(), z.to_bits()],
        );
        let rows = [
            (&camera.u, &mut setup.u),
            (&camera.v, &mut setup.v),
            (&camera.n, &mut setup.n),
        ];
        let translations = camera.translation.iter().zip(&mut setup.translation);
        let mut room = 0;
        for ((row, result), (of_camera, translation)) in rows.into_iter().zip(translations) {
            // |row·A| ≤ 2^24·16·√3, so every entry fits 30 bits after this rounding.
            let (x, y, z) = (
                nearest_24(dot(row, &a)),
                nearest_24(dot(row, &b)),
                nearest_24(dot(row, &c)),
            );
            *result = [x, y, z];
            room |= rounded_room(x) | rounded_room(y) | rounded_room(z);
            // The length of a row is below 2^24.5, and that of a position vector is at most √3·2^29, so the product is below 2^55.
            *translation = of_camera + nearest_10(dot(row, &place));
        }
        let [x, y, z] = setup.translation;
        // The light is in the coordinates of the mesh, or, if the normals are transformed, in world coordinates.
        setup.light = if self.has_normals_in_world() {
            camera.light
        } else {
            let (row, [a, b, c]) = (&camera.light, &self.rotation);
            [
                nearest_24(dot(row, a)),
                nearest_24(dot(row, b)),
                nearest_24(dot(row, c)),
            ]
        };
        setup.scale_shift = camera.scale_shift;
        setup.near = camera.near;
        setup.depth.exponent = camera.depth.exponent;
        setup.is_placed = true;
        setup.mirrors = self.matrix.mirrors();
        let reach = self.reach(radius);
        // A relative margin of 2^−12 covers the errors of the camera's axes.
        let reach = reach + (reach >> 12);
        // Most objects fit the formats of the vertex stage without scaling.
        let widest = x.abs().max(y.abs()) + reach;
        let deepest = z.abs() + (reach >> 1);
        let is_perspective = camera.projection == Projection::Perspective;
        if room < 1 << 24 && widest >> 42 == 0 && deepest >> 41 == 0 && is_perspective {
            return Ok(());
        }
        fit(setup, view, camera, [widest, deepest])
    }
}

/// Multiplies the homogeneous coordinates of an object by 2^−k, and the object's rows by the power of two with which they fit their
/// formats. `setup` has the constants without these factors. `widest` is the largest |X| or |Y|, and `deepest` is the largest |Z|.
///
/// Not inlined, because few objects need it.
#[inline(never)]
fn fit(
    setup: &mut MeshSetup,
    view: &View,
    camera: &MeshSetup,
    [widest, deepest]: [i64; 2],
) -> Result<(), RenderError> {
    let MeshSetup { u, v, n, .. } = *setup;
    let mut k = excess(largest(&n)).max(halvings((deepest >> 41) as u32));
    let mut f = camera.scale_shift;
    let is_perspective = camera.projection == Projection::Perspective;
    if is_perspective {
        f += k;
    } else {
        // The vertex stage supports depths of up to 16 world units, for which ke is 5.
        k = k.max((camera.depth.exponent - 5).max(0) as u32);
    }
    // The rows u and v get as many fraction bits as fit: f − cut.
    let cut = excess(largest(&u).max(largest(&v)))
        .max(halvings((widest >> 42) as u32))
        .max(f.saturating_sub(18));
    let scale_shift = f.saturating_sub(cut);
    let near = camera.near >> k;
    if is_perspective {
        // The leading bit of the near plane is bit 30 or higher, and at least bit 40 − f after the change of f.
        let lead = 40_u32.saturating_sub(scale_shift).max(30);
        if near >> lead == 0 {
            let least = u32::try_from((1_u64 << (lead + k)) >> 9);
            return Err(RenderError::Near {
                near: view.near(),
                least: U4_28::from_bits(least.unwrap_or(u32::MAX)),
            });
        }
    } else if f < cut + LEAST_SHIFT {
        let width = view.half_width().to_bits() << 1;
        return Err(RenderError::Width {
            width: U8_28::from_bits(width),
            least: U8_28::from_bits(width << (cut + LEAST_SHIFT - f)),
        });
    }
    let [x, y, z] = setup.translation;
    setup.scale_shift = scale_shift;
    setup.u = halved(u, cut);
    setup.v = halved(v, cut);
    setup.n = halved(n, k);
    setup.translation = [shifted(x, cut), shifted(y, cut), shifted(z, k)];
    setup.near = near;
    setup.depth.exponent -= k as i32;
    if let Volume::View { far } = &mut setup.volume {
        *far >>= k;
    }
    Ok(())
}

/// The exact scalar product, which is below 2^62 for rows, columns of matrices and positions.
#[inline(always)]
const fn dot(a: &[i32; 3], b: &[i32; 3]) -> i64 {
    wide(a[0], b[0]) + wide(a[1], b[1]) + wide(a[2], b[2])
}

/// Removes 10 fraction bits, rounded to nearest.
#[inline(always)]
const fn nearest_10(x: i64) -> i64 {
    (x + (1 << 9)) >> 10
}

/// Removes 24 fraction bits, rounded to nearest, of a number below 2^55.
#[inline(always)]
const fn nearest_24(x: i64) -> i32 {
    ((x + (1 << 23)) >> 24) as i32
}

/// The exact product of two 32-bit numbers.
#[inline(always)]
const fn wide(a: i32, b: i32) -> i64 {
    a as i64 * b as i64
}

fn transposed([a, b, c]: [[i32; 3]; 3]) -> [[i32; 3]; 3] {
    [0, 1, 2].map(|j| [a[j], b[j], c[j]])
}

/// Number of halvings after which a number is 0.
const fn halvings(x: u32) -> u32 {
    // A loop, because most numbers are 0, and the soft core counts leading zeros in software.
    let (mut x, mut count) = (x, 0);
    while x > 0 {
        x >>= 1;
        count += 1;
    }
    count
}

/// The magnitude plus [`MOST_ROUNDING`], or more.
#[inline(always)]
const fn rounded_room(x: i32) -> u32 {
    (x ^ (x >> 31)) as u32 + 1 + MOST_ROUNDING
}

/// The largest magnitude of a row's components; below 2^30.
fn largest(row: &[i32; 3]) -> u32 {
    let [x, y, z] = row.map(i32::unsigned_abs);
    x.max(y).max(z)
}

/// Smallest number of halvings after which a number below 2^30, rounded, is less than 2^24.
const fn excess(x: u32) -> u32 {
    // The largest rounding is added first, so that the rounded number is also below the next power of two.
    halvings((x + MOST_ROUNDING) >> 24)
}

/// Largest number that is added for rounding: half a unit of the result after six halvings.
const MOST_ROUNDING: u32 = 1 << 5;

/// Divides by 2^`shift`, rounded to nearest.
fn halved(row: [i32; 3], shift: u32) -> [i32; 3] {
    row.map(|x| (x + ((1 << shift) >> 1)) >> shift)
}

/// Divides by 2^`shift`, rounded to nearest. Fast for a `shift` of 0, which most objects have.
const fn shifted(x: i64, shift: u32) -> i64 {
    if shift == 0 {
        return x;
    }
    ((x >> (shift - 1)) + 1) >> 1
}
