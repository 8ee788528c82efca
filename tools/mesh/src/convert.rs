//! Conversion of polygons to a board's mesh: scaling, triangulation, normals, rounding to Q2.14.

mod back_faces;
mod order;
mod rounding;
mod textures;
mod winding;

use crate::error::FormatError;
use crate::normals::NormalSums;
use crate::polygons::{Corner, Polygons, Rgb8, Vector};
use crate::triangulate::{self, area_vector, dot, unit};
use glint_core::mesh::{IndexedTriangle, Rgb565, Vertex};
use glint_core::records::TextureCoordinates;
use order::{Encoded, Extra};
use rounding::{ONE, Placing, Rounded, Unusual};
use serde::Serialize;
use std::borrow::Cow;
use std::collections::HashMap;
use textures::Textures;
pub use textures::{TextureOptions, TextureReport};

/// Options of a conversion.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// Keeps the coordinates. Otherwise the mesh is scaled to the 1×1×1 box about the origin.
    pub keep_scale: bool,
    /// Keeps the triangles in the order of the file. Otherwise triangles with blended textures come last, in the order of the file, and the
    /// other triangles are reordered if this reduces the number of vertices that the engine fetches.
    pub keep_order: bool,
    /// Reverses faces with the wrong winding.
    pub fix_winding: bool,
    /// The conversion of textures.
    pub textures: TextureOptions,
}

/// Report of a conversion.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Number of points in the file.
    pub points: usize,
    /// Number of polygons in the file, plus the added back faces.
    pub faces: usize,
    /// Whether the surface is known to be smooth: the file has a normal for each corner, or the generator states it. False for `.glm` files,
    /// whose normals may be averages of face normals.
    pub smooth: bool,
    /// Number of vertices in the mesh. A vertex in several chunks is counted once per chunk.
    pub vertices: u32,
    /// Number of triangles in the mesh.
    pub triangles: u32,
    /// Triangles dropped because they have no area after rounding.
    pub degenerate: usize,
    /// Number of chunks of the mesh, each of at most 65,535 vertices.
    pub chunks: usize,
    /// Number of vertices that the engine would fetch for a frame with the triangles in the order of the file.
    pub fetches_before: u32,
    /// Number of vertices that the engine fetches for a frame of this mesh.
    pub fetches: u32,
    /// The mesh's length in bytes.
    pub bytes: usize,
    /// Factor that converts the file's lengths to world units.
    pub scale: f64,
    /// The point, in the file's coordinates, that became the origin.
    pub centre: Vector,
    /// Maximum distance between a scaled point and its rounded vertex, in world units.
    pub error_max: f64,
    /// Root mean square of the distances between scaled points and their rounded vertices, in world units.
    pub error_rms: f64,
    /// `error_max` in units of 2^-14.
    pub error_max_lsb: f64,
    /// `error_rms` in units of 2^-14.
    pub error_rms_lsb: f64,
    /// The textures of the mesh.
    pub textures: Vec<TextureReport>,
    /// Remarks for the user, such as a warning that the file may be damaged.
    pub remarks: Vec<String>,
}

/// Converts polygons with checked indices to the board's memory layout.
///
/// # Errors
/// The mesh has no extent, exceeds Q2.14 (with `keep_scale`), has no triangle of non-zero area, or
/// is too large, including its textures.
pub fn convert(polygons: &Polygons, options: Options) -> Result<(Vec<u8>, Report), FormatError> {
    let unusual = Unusual::of(polygons).filter(|_| !options.keep_scale);
    let polygons = &*prepared(polygons, options, unusual)?;
    let placing = Placing::of(polygons, options.keep_scale)?;
    let rounded = Rounded::of(polygons, &placing)?;
    let (mut triangles, degenerate, crossing) = flat_triangles(polygons, &rounded);
    if triangles.is_empty() {
        return Err(FormatError::whole(
            "a triangle with an area at a resolution of 2^-14",
            format!("only degenerate ones ({degenerate})"),
        ));
    }
    let textures = Textures::of(polygons, &options.textures);
    triangles.retain(|triangle| !textures.hides(&polygons.faces[triangle.face]));
    if triangles.is_empty() {
        let found = "only faces that are less than a sixteenth opaque";
        return Err(FormatError::whole("a visible face", found));
    }
    let Indexed {
        vertices,
        coordinates,
        triangles: mut indexed,
    } = index(polygons, &rounded, &triangles, &textures);
    // A blended triangle must be drawn after the opaque triangles behind it. The sort is stable, so blended triangles keep the order of the
    // file.
    let is_blended = |triangle: &IndexedTriangle| textures.is_blended(triangle.texture);
    if !options.keep_order {
        indexed.sort_by_key(is_blended);
    }
    let extra = Extra {
        coordinates: &coordinates,
        textures: &textures.encoded,
    };
    let in_file_order = Encoded::new(&vertices, &indexed, &extra)?;
    let fetches_before = in_file_order.fetches;
    let ordered = if options.keep_order {
        None
    } else {
        let (opaque, blended) = indexed.split_at(indexed.partition_point(|one| !is_blended(one)));
        let ordered = [&order::for_cache(vertices.len(), opaque)[..], blended].concat();
        let encoded = Encoded::new(&vertices, &ordered, &extra)?;
        (encoded.fetches < fetches_before).then_some(encoded)
    };
    let Encoded { bytes, fetches } = ordered.unwrap_or(in_file_order);
    let written = crate::formats::glm::check(&bytes)?;
    let report = Report {
        points: polygons.points.len(),
        smooth: polygons.is_smooth.unwrap_or_else(|| {
            let mut corners = polygons.corners.iter();
            corners.all(|corner| corner.normal != Corner::NO_NORMAL)
        }),
        faces: polygons.faces.len(),
        vertices: written.vertex_count(),
        triangles: written.triangle_count(),
        degenerate,
        chunks: written.chunks().count(),
        fetches_before,
        fetches,
        bytes: bytes.len(),
        scale: unusual.map_or(placing.scale, |unusual| unusual.apply(placing.scale)),
        centre: placing
            .centre
            .map(|c| unusual.map_or(c, |unusual| unusual.undo(c))),
        error_max: rounded.error_max,
        error_rms: rounded.error_rms,
        error_max_lsb: rounded.error_max * ONE,
        error_rms_lsb: rounded.error_rms * ONE,
        textures: textures.reports,
        remarks: (polygons.remarks.iter().cloned())
            .chain(crossing)
            .chain(textures.remarks)
            .collect(),
    };
    Ok((bytes, report))
}

/// Prepares a copy of the polygons: scales unusual magnitudes, repairs the winding if `options`
/// requests it, and adds back faces of double-sided faces that can be visible.
fn prepared(
    polygons: &Polygons,
    options: Options,
    unusual: Option<Unusual>,
) -> Result<Cow<'_, Polygons>, FormatError> {
    let mut polygons = Cow::Borrowed(polygons);
    if let Some(unusual) = unusual {
        for c in polygons.to_mut().points.as_flattened_mut() {
            *c = unusual.apply(*c);
        }
    }
    if options.fix_winding {
        winding::repair(polygons.to_mut());
    }
    if back_faces::are_needed(&polygons) {
        back_faces::add(polygons.to_mut())?;
    }
    Ok(polygons)
}

/// Translates and scales the points, repairs the winding and adds back faces like [`convert`], but
/// without rounding and in the order of the file.
///
/// # Errors
/// The mesh has no extent, or too many triangles.
pub fn place(polygons: &mut Polygons, options: Options) -> Result<(), FormatError> {
    let unusual = Unusual::of(polygons).filter(|_| !options.keep_scale);
    if let Cow::Owned(prepared) = prepared(polygons, options, unusual)? {
        *polygons = prepared;
    }
    let mut crossing = Crossing::default();
    let mut scratch = triangulate::Scratch::default();
    for (number, face) in polygons.faces.iter().enumerate() {
        triangulate::face(polygons, face, &mut scratch);
        crossing.count(number, &scratch);
    }
    polygons.remarks.extend(crossing.remark());
    let placing = Placing::of(polygons, options.keep_scale)?;
    for point in &mut polygons.points {
        *point = placing.apply(*point);
    }
    Ok(())
}

/// A triangle of non-zero area, and its face normal.
struct FlatTriangle {
    corners: [Corner; 3],
    normal: Vector,
    /// Index of its face.
    face: usize,
}

/// Returns all triangles of non-zero area after rounding, the number of triangles of area 0, and a
/// remark on self-intersecting faces.
fn flat_triangles(
    polygons: &Polygons,
    rounded: &Rounded,
) -> (Vec<FlatTriangle>, usize, Option<String>) {
    let mut triangles = Vec::with_capacity(polygons.triangle_count());
    let mut degenerate = 0;
    let mut crossing = Crossing::default();
    let mut scratch = triangulate::Scratch::default();
    for (number, face) in polygons.faces.iter().enumerate() {
        for &corners in triangulate::face(polygons, face, &mut scratch) {
            match normal(polygons, rounded, corners) {
                Some(normal) => triangles.push(FlatTriangle {
                    corners,
                    normal,
                    face: number,
                }),
                None => degenerate += 1,
            }
        }
        crossing.count(number, &scratch);
    }
    (triangles, degenerate, crossing.remark())
}

/// Self-intersecting faces: how many exist, and the number of the first of them, counted from 1.
#[derive(Default)]
struct Crossing {
    count: usize,
    first: usize,
}

impl Crossing {
    /// Counts the face with this number if its triangulation, which has just filled `scratch`,
    /// found a self-intersection.
    fn count(&mut self, number: usize, scratch: &triangulate::Scratch) {
        if scratch.crosses {
            self.count += 1;
            if self.count == 1 {
                self.first = number + 1;
            }
        }
    }

    fn remark(&self) -> Option<String> {
        let Self { count, first } = self;
        match count {
            0 => None,
            1 => Some(format!(
                "face {first} crosses itself: its triangles overlap"
            )),
            _ => Some(format!(
                "{count} faces cross themselves, the first is face {first}: their triangles overlap"
            )),
        }
    }
}

/// Returns the unit normal of a triangle, from its corners before rounding; `None` for a triangle
/// of area 0 after rounding.
fn normal(polygons: &Polygons, rounded: &Rounded, corners: [Corner; 3]) -> Option<Vector> {
    // Differences of rounded coordinates have 17 bits, and their products are exact in f64, so `unit` returns `None` exactly for
    // an area of zero.
    let after = unit(area_vector(
        corners.map(|corner| rounded.position(corner).map(f64::from)),
    ))?;
    let before = unit(area_vector(corners.map(|corner| polygons.point(corner))));
    // Rounding may flip a very narrow triangle. The normal is then computed from the rounded
    // corners, because the board draws the rounded triangle.
    Some(
        before
            .filter(|before| dot(*before, after) > 0.0)
            .unwrap_or(after),
    )
}

/// The vertices of a mesh, and its triangles as indices of vertices.
struct Indexed {
    vertices: Vec<Vertex>,
    /// The texture coordinates of the vertices, in the board's memory layout; empty without textures.
    coordinates: Vec<u8>,
    triangles: Vec<IndexedTriangle>,
}

/// Returns the mesh's unique vertices, and its triangles as indices of vertices.
fn index(
    polygons: &Polygons,
    rounded: &Rounded,
    triangles: &[FlatTriangle],
    textures: &Textures,
) -> Indexed {
    let mut smooth = NormalSums::new(rounded.positions.len());
    for triangle in triangles {
        let numbers = triangle
            .corners
            .map(|corner| rounded.number(corner) as usize);
        smooth.add(
            numbers,
            triangle.corners.map(|corner| polygons.point(corner)),
            triangle.normal,
        );
    }
    let mut vertices = Vec::new();
    let mut coordinates = Vec::new();
    let mut numbers: HashMap<VertexKey, u32> = HashMap::new();
    let mut indexed = Vec::with_capacity(triangles.len());
    for triangle in triangles {
        let face = &polygons.faces[triangle.face];
        let texture = textures.number(polygons, face);
        let no_colour = if texture == 0 {
            Rgb8::DEFAULT
        } else {
            Rgb8::WHITE
        };
        let indices = triangle.corners.map(|corner| {
            let given = polygons
                .normals
                .get(corner.normal as usize)
                .copied()
                .and_then(unit);
            let normal = given
                .or_else(|| smooth.at(rounded.number(corner) as usize))
                .unwrap_or(triangle.normal);
            let colour = point_colour(polygons, corner).or(face.colour);
            let vertex = Vertex {
                position: rounded.position(corner),
                normal: direction(normal),
                ..Vertex::default()
            }
            .with_rgb888(colour.unwrap_or(no_colour).0);
            let [s, t] = if texture == 0 {
                [0; 2]
            } else {
                textures.coordinates(polygons, triangle.face, corner)
            };
            *numbers
                .entry(VertexKey(
                    vertex.position,
                    vertex.normal,
                    vertex.rgb888(),
                    [s, t],
                ))
                .or_insert_with(|| {
                    vertices.push(vertex);
                    if !textures.encoded.is_empty() {
                        coordinates.extend(TextureCoordinates { s, t }.to_bytes());
                    }
                    (vertices.len() - 1) as u32
                })
        });
        let colour = (face.colour).or_else(|| mean_colour(polygons, triangle.corners));
        indexed.push(IndexedTriangle {
            indices,
            colour: rgb565(colour.unwrap_or(no_colour)),
            normal: direction(triangle.normal),
            texture,
        });
    }
    Indexed {
        vertices,
        coordinates,
        triangles: indexed,
    }
}

/// Position, normal, colour and texture coordinates of a vertex. Equal vertices become one vertex of the mesh.
#[derive(PartialEq, Eq, Hash)]
struct VertexKey([i16; 3], [i16; 3], [u8; 3], [i32; 2]);

/// Rounds a unit vector to Q2.14, to nearest.
fn direction(unit: Vector) -> [i16; 3] {
    unit.map(|c| (c * ONE + 0.5).floor() as i16)
}

fn rgb565(colour: Rgb8) -> Rgb565 {
    Rgb565::from_rgb888(colour.0)
}

fn point_colour(polygons: &Polygons, corner: Corner) -> Option<Rgb8> {
    polygons.point_colours.get(corner.point as usize).copied()
}

/// Flat colour of a triangle whose points have colours: the mean of its corners' colours.
fn mean_colour(polygons: &Polygons, corners: [Corner; 3]) -> Option<Rgb8> {
    let mut sums = [0_u16; 3];
    for corner in corners {
        let Rgb8(rgb) = point_colour(polygons, corner)?;
        for (sum, c) in sums.iter_mut().zip(rgb) {
            *sum += u16::from(c);
        }
    }
    Some(Rgb8(sums.map(|sum| ((sum + 1) / 3) as u8)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Location;
    use crate::formats::glm;

    fn soup(points: &[Vector], faces: &[&[u32]]) -> Polygons {
        let mut polygons = Polygons::default();
        for &point in points {
            polygons.add_point(point, Location::Whole).unwrap();
        }
        for face in faces {
            let corners: Vec<Corner> = face.iter().map(|&point| Corner::at(point)).collect();
            polygons.add_face(&corners, None, Location::Whole).unwrap();
        }
        polygons.finish().unwrap();
        polygons
    }

    fn keep() -> Options {
        Options {
            keep_scale: true,
            ..Options::default()
        }
    }

    #[test]
    fn scaled_to_the_unit_box() {
        // No face uses the last point, so it does not affect the scale.
        let polygons = soup(
            &[
                [10.0, 0.0, 0.0],
                [14.0, 0.0, 0.0],
                [10.0, 2.0, 0.0],
                [99.0, 99.0, 99.0],
            ],
            &[&[0, 1, 2]],
        );
        let (bytes, report) = convert(&polygons, Options::default()).unwrap();
        assert_eq!((report.scale, report.centre), (0.25, [12.0, 1.0, 0.0]));
        assert_eq!(
            (report.vertices, report.triangles, report.error_max),
            (3, 1, 0.0)
        );
        let chunk = glm::check(&bytes).unwrap().chunks().next().unwrap();
        let positions: Vec<[i16; 3]> = chunk.vertices().map(|v| v.position).collect();
        assert_eq!(
            positions,
            [[-8192, -4096, 0], [8192, -4096, 0], [-8192, 4096, 0]]
        );
    }

    #[test]
    fn kept_scale_is_refused_where_it_does_not_fit() {
        let triangle = |x: f64| {
            let points = [[-2.0, 0.0, 0.0], [x, 0.0, 0.0], [0.0, 1.0, 0.0]];
            convert(&soup(&points, &[&[0, 1, 2]]), keep())
        };
        assert!(triangle(2.0 - 1.0 / ONE).is_ok());
        assert_eq!(triangle(2.0).unwrap_err().found, "point 1 at (2, 0, 0)");
    }

    #[test]
    fn degenerate_triangles_are_dropped_and_counted() {
        let tiny = 0.2 / ONE;
        let points = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [tiny, 0.0, 0.0],
            [0.5, 0.0, 0.0],
        ];
        let (_, report) = convert(
            &soup(&points, &[&[0, 1, 2], &[0, 3, 2], &[0, 4, 1]]),
            keep(),
        )
        .unwrap();
        assert_eq!(
            (report.triangles, report.degenerate, report.vertices),
            (1, 2, 3)
        );
        assert!((report.error_max_lsb - 0.2).abs() < 1e-9);
        assert!((report.error_rms_lsb - 0.2 / 5f64.sqrt()).abs() < 1e-9);
        let error = convert(&soup(&points, &[&[0, 3, 2]]), keep()).unwrap_err();
        assert_eq!(error.found, "only degenerate ones (1)");
    }

    #[test]
    fn faces_that_cross_themselves_are_remarked() {
        let points = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let remarks = |faces: &[&[u32]]| {
            let mut polygons = soup(&points, faces);
            let report = convert(&polygons, Options::default()).unwrap().1;
            place(&mut polygons, Options::default()).unwrap();
            assert_eq!(polygons.remarks, report.remarks);
            report.remarks
        };
        assert!(remarks(&[&[0, 1, 2, 3], &[3, 2, 1, 0]]).is_empty());
        assert_eq!(
            remarks(&[&[0, 1, 2, 3], &[0, 1, 3, 2]]),
            ["face 2 crosses itself: its triangles overlap"]
        );
        assert_eq!(
            remarks(&[&[0, 2, 1, 3], &[0, 1, 3, 2]]),
            ["2 faces cross themselves, the first is face 1: their triangles overlap"]
        );
    }

    /// The magnitude of the coordinates does not affect the result.
    #[test]
    fn every_finite_magnitude() {
        let converted = |exponent: i32| {
            let size = 2f64.powi(exponent);
            let points = [[-size, 0.0, 0.0], [size, 0.0, 0.0], [0.0, 0.75 * size, 0.0]];
            let options = Options {
                fix_winding: true,
                ..Options::default()
            };
            let mut polygons = soup(&points, &[&[0, 1, 2]]);
            let (bytes, report) = convert(&polygons, options).unwrap();
            place(&mut polygons, options).unwrap();
            assert_eq!(polygons.points[1], [0.5, -0.1875, 0.0]);
            let centre = report.centre[1] / size;
            assert_eq!([report.scale * size, centre], [0.5, 0.375], "{exponent}");
            bytes
        };
        let usual = converted(0);
        for exponent in [-1022, -600, -201, -100, 100, 201, 600, 1022] {
            assert!(converted(exponent) == usual, "{exponent}");
        }
        // The smallest positive number, and the largest number.
        for size in [f64::from_bits(1), f64::MAX] {
            let points = [[-size, 0.0, 0.0], [size, 0.0, 0.0], [0.0, size, 0.0]];
            let polygons = soup(&points, &[&[0, 1, 2]]);
            let (_, report) = convert(&polygons, Options::default()).unwrap();
            assert_eq!(report.triangles, 1);
        }
    }

    #[test]
    fn no_extent() {
        let polygons = soup(&[[1.0; 3]; 3], &[&[0, 1, 2]]);
        let error = convert(&polygons, Options::default())
            .unwrap_err()
            .to_string();
        assert_eq!(error, "expected a mesh with an extent, found extent 0e0");
    }

    #[test]
    fn normals_of_a_corner() {
        // Three faces at a cube's corner: for any triangulation of the faces, the shared normal is
        // the diagonal of the cube.
        let polygons = soup(
            &[
                [0.0, 0.0, 0.0],
                [-1.0, 0.0, 0.0],
                [0.0, -1.0, 0.0],
                [0.0, 0.0, -1.0],
                [-1.0, -1.0, 0.0],
                [0.0, -1.0, -1.0],
                [-1.0, 0.0, -1.0],
            ],
            &[&[0, 1, 4, 2], &[0, 2, 5, 3], &[0, 3, 6, 1]],
        );
        let (bytes, _) = convert(&polygons, keep()).unwrap();
        let chunk = glm::check(&bytes).unwrap().chunks().next().unwrap();
        let corner = chunk.vertices().find(|v| v.position == [0; 3]).unwrap();
        let diagonal = (ONE / 3f64.sqrt() + 0.5).floor() as i16;
        assert_eq!(corner.normal, [diagonal; 3]);
        let normals: Vec<[i16; 3]> = chunk.triangles().map(|t| t.normal).collect();
        let one = ONE as i16;
        assert_eq!(normals[0], [0, 0, one]);
        assert_eq!(normals[2], [one, 0, 0]);
    }

    #[test]
    fn colours_of_faces_points_and_none() {
        let mut polygons = soup(
            &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]],
            &[&[0, 1, 2], &[1, 3, 2]],
        );
        polygons.faces[0].colour = Some(Rgb8([255, 0, 0]));
        let colours = |polygons: &Polygons| -> (Vec<u16>, u32) {
            let (bytes, report) = convert(polygons, keep()).unwrap();
            let chunk = glm::check(&bytes).unwrap().chunks().next().unwrap();
            let colours = chunk.triangles().map(|t| t.colour.0);
            (colours.collect(), report.vertices)
        };
        let default = Rgb565::from_rgb888(Rgb8::DEFAULT.0).0;
        // Points between faces of different colours become two vertices each.
        assert_eq!(colours(&polygons), (vec![0xf800, default], 6));
        polygons.point_colours = [0, 0, 255, 255].map(|green| Rgb8([0, green, 255])).into();
        let mean = Rgb565::from_rgb888([0, 170, 255]).0;
        assert_eq!(colours(&polygons), (vec![0xf800, mean], 4));
    }

    /// Colours of points pass through a GLM unchanged, also if they are equal in RGB565.
    #[test]
    fn colours_of_points_keep_eight_bits() {
        let mut polygons = soup(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[&[0, 1, 2]]);
        let colours = [[128, 128, 135], [131, 129, 130], [131, 129, 131]].map(Rgb8);
        polygons.point_colours = colours.into();
        let (bytes, _) = convert(&polygons, keep()).unwrap();
        let read = glm::parse(&bytes).unwrap();
        assert_eq!(read.point_colours, colours);
    }
}
