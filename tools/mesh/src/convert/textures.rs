//! The textures of a mesh for boards, and the texture coordinates of its faces.

use crate::error::MAX_REMARKS;
use crate::polygons::{Content, Corner, Face, Polygons, Texture};
use glint_core::mesh::MAX_BYTES;
use glint_core::texture::{self, Blend, Filter, Format, Sampler, Wrap};
use glint_texture::convert::{Report, again, convert};
use glint_texture::error::PictureError;
use glint_texture::options::{MAX_SIDE, MIN_SIDE, Options};
use glint_texture::picture::Picture;
use serde::Serialize;
use std::collections::HashMap;
use std::sync::Arc;

/// One in s16.16.
const ONE: f64 = 65536.0;

/// Typical size of a triangle in bytes, with its share of the vertices and their texture
/// coordinates.
const TRIANGLE_BYTES: usize = 40;
/// Minimum space in bytes for the textures of a mesh with any number of triangles: 255 textures of
/// the smallest size fit.
const MIN_ROOM: usize = 1 << 20;

/// Options of the conversion of textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureOptions {
    /// Leaves the textures out; faces keep their own colours.
    pub left_out: bool,
    /// The representation of texels. `None` selects RGB565 for pictures, and keeps the
    /// representation of a texture in a board's memory layout.
    pub format: Option<Format>,
    /// The largest side in texels.
    pub largest_side: u32,
    /// The filter; `None` keeps the filter that the file states.
    pub filter: Option<Filter>,
    /// How the textures are blended with the picture behind them; `None` keeps what the file states.
    pub blend: Option<Blend>,
}

impl Default for TextureOptions {
    fn default() -> Self {
        Self {
            left_out: false,
            format: None,
            largest_side: MAX_SIDE,
            filter: None,
            blend: None,
        }
    }
}

/// Report on a texture.
#[derive(Clone, Debug, Serialize)]
pub struct TextureReport {
    /// The name of its file, or its number in the file of the mesh.
    pub name: String,
    /// Sizes and errors.
    #[serde(flatten)]
    pub report: Report,
}

/// The textures that the faces of a mesh use, converted for boards.
#[derive(Default)]
pub struct Textures {
    /// For each texture of the file, the number of its converted texture, counted from 1; 0 for
    /// none.
    numbers: Vec<u8>,
    /// For each texture of the file, whether its faces are invisible.
    hidden: Vec<bool>,
    /// For each converted texture, whether it is blended with the picture behind it.
    blended: Vec<bool>,
    /// For each face, the whole repeats of the texture that are subtracted from its coordinates;
    /// empty without textures.
    bases: Vec<[f64; 2]>,
    /// The textures in the board's memory layout.
    pub encoded: Vec<Vec<u8>>,
    /// Reports on the textures.
    pub reports: Vec<TextureReport>,
    /// Remarks for the user, at most [`MAX_REMARKS`].
    pub remarks: Vec<String>,
}

impl Textures {
    /// Converts the textures that faces use, and prepares their coordinates. If a picture cannot be
    /// used, its faces keep their own colours. Textures that exceed a mesh's memory are made
    /// smaller. Both add a remark.
    pub fn of(polygons: &Polygons, options: &TextureOptions) -> Self {
        let mut textures = Self::default();
        if options.left_out || polygons.textures.is_empty() {
            return textures;
        }
        let mut is_used = vec![false; polygons.textures.len()];
        let mut without = 0;
        for face in &polygons.faces {
            let Some(is_used) = place(face).and_then(|i| is_used.get_mut(i)) else {
                continue;
            };
            if has_coordinates(polygons, face) {
                *is_used = true;
            } else {
                without += 1;
            }
        }
        if without > 0 {
            textures.remark(format!(
                "{without} faces have a texture and no texture coordinates: they keep their own colours"
            ));
        }
        let room = (MAX_BYTES as usize).saturating_sub(TRIANGLE_BYTES * polygons.triangle_count());
        let room = room.max(MIN_ROOM);
        let mut smaller = *options;
        while !textures.convert(polygons, &is_used, room, &smaller)
            && smaller.largest_side > MIN_SIDE
        {
            let half = smaller.largest_side.next_power_of_two() / 2;
            smaller.largest_side = half.max(MIN_SIDE);
        }
        let faces = polygons.faces.iter();
        let hidden = faces.filter(|face| textures.hides(face)).count();
        if hidden > 0 {
            textures.remark(format!(
                "{hidden} faces are less than a sixteenth opaque: they are left out; `--blend` shows them"
            ));
        }
        if smaller.largest_side < options.largest_side {
            textures.remark(format!(
                "textures have at most {} texels a side, so that they fit a mesh of {MAX_BYTES} bytes",
                smaller.largest_side
            ));
        }
        if !textures.encoded.is_empty() {
            textures.bases = bases(polygons, &textures);
            textures.remark_beyond(polygons);
        }
        textures
    }

    /// Converts the used textures, and returns whether they fit `room` bytes.
    fn convert(
        &mut self,
        polygons: &Polygons,
        is_used: &[bool],
        room: usize,
        options: &TextureOptions,
    ) -> bool {
        self.numbers = vec![0; polygons.textures.len()];
        self.hidden = vec![false; polygons.textures.len()];
        self.blended.clear();
        self.encoded.clear();
        self.reports.clear();
        let mut remarks = Vec::new();
        let mut last = None;
        let mut bytes = 0;
        let used = polygons.textures.iter().zip(is_used).enumerate();
        for (i, (texture, _)) in used.filter(|(_, (_, is_used))| **is_used) {
            match encode(texture, options, &mut last) {
                Ok(None) => self.hidden[i] = true,
                Ok(Some((encoded, report))) => {
                    bytes += encoded.len();
                    if bytes > room {
                        return false;
                    }
                    let is_blended = texture::Texture::new_checked(&encoded)
                        .is_ok_and(|texture| texture.blend() != Blend::Opaque);
                    self.encoded.push(encoded);
                    self.reports.push(TextureReport {
                        name: texture.name.clone(),
                        report,
                    });
                    self.blended.push(is_blended);
                    self.numbers[i] = self.encoded.len() as u8;
                }
                Err(error) => remarks.push(format!(
                    "texture {}: {error}: its faces keep their own colours",
                    texture.name
                )),
            }
        }
        remarks.into_iter().for_each(|remark| self.remark(remark));
        true
    }

    /// Whether a face is left out, because it is invisible.
    pub fn hides(&self, face: &Face) -> bool {
        place(face).is_some_and(|i| self.hidden.get(i).is_some_and(|&is_hidden| is_hidden))
    }

    /// Whether the converted texture with this number, counted from 1, is blended with the picture behind it; `false` for 0.
    pub fn is_blended(&self, number: u8) -> bool {
        let index = usize::from(number).checked_sub(1);
        index.is_some_and(|i| self.blended.get(i).is_some_and(|&is_blended| is_blended))
    }

    /// The number of a face's converted texture, counted from 1; 0 for none.
    pub fn number(&self, polygons: &Polygons, face: &Face) -> u8 {
        let number = place(face).and_then(|i| self.numbers.get(i)).copied();
        number
            .filter(|_| has_coordinates(polygons, face))
            .unwrap_or(0)
    }

    /// The texture coordinates s and t of a corner of the face with the index `face`, in s16.16,
    /// rounded to nearest and saturated; 0 without texture coordinates.
    pub fn coordinates(&self, polygons: &Polygons, face: usize, corner: Corner) -> [i32; 2] {
        let Some(base) = self.bases.get(face) else {
            return [0; 2];
        };
        let coordinates = polygons.coordinates.get(corner.coordinates as usize);
        coordinates.map_or([0; 2], |coordinates| {
            // The conversion `as i32` saturates.
            [0, 1].map(|axis| ((coordinates[axis] - base[axis]) * ONE).round() as i32)
        })
    }

    /// Adds a remark if texture coordinates exceed s16.16.
    fn remark_beyond(&mut self, polygons: &Polygons) {
        let faces = polygons.faces.iter().enumerate();
        let faces = faces.filter(|(_, face)| self.number(polygons, face) != 0);
        let beyond = faces.filter(|&(number, face)| {
            let corners = polygons.corners_of(face).iter();
            let mut all = corners.flat_map(|&c| self.coordinates(polygons, number, c));
            all.any(|c| c == i32::MIN || c == i32::MAX)
        });
        let count = beyond.count();
        if count > 0 {
            self.remark(format!(
                "{count} faces have texture coordinates beyond 32768 repeats, which are clamped"
            ));
        }
    }

    fn remark(&mut self, remark: String) {
        if self.remarks.len() < MAX_REMARKS {
            self.remarks.push(remark);
        }
    }
}

/// Index of a face's texture; `None` for a face without a texture.
fn place(face: &Face) -> Option<usize> {
    usize::from(face.texture).checked_sub(1)
}

/// Whether a face has the texture coordinates that its texture needs.
fn has_coordinates(polygons: &Polygons, face: &Face) -> bool {
    let mut corners = polygons.corners_of(face).iter();
    corners.all(|corner| corner.coordinates != Corner::NO_COORDINATES) || is_white(polygons, face)
}

fn is_white(polygons: &Polygons, face: &Face) -> bool {
    let texture = place(face).and_then(|i| polygons.textures.get(i));
    texture.is_some_and(|texture| texture.content == Content::White)
}

/// Opacity below which texels of a blended texture are transparent: less than half of an eighth.
const INVISIBLE: f32 = 1.0 / 16.0;

/// Blend of surfaces with this opacity and this texture picture: the product of `opacity` and the average opacity of the texels at or above
/// the cutoff, rounded to the nearest eighth. `None` if the surfaces are invisible.
fn share(opacity: u8, picture: &Picture, cutoff: f32) -> Option<Blend> {
    let least = (cutoff * 255.0).ceil() as u8;
    let opacities = picture.texels.iter().map(|texel| texel[3]);
    let (mut sum, mut count) = (0_u64, 0_u64);
    for opacity in opacities.filter(|&opacity| opacity >= least) {
        sum += u64::from(opacity);
        count += 1;
    }
    // In units of 1/255²; a picture has at most 2^26 texels.
    let mean = u64::from(opacity) * sum / count.max(1);
    match (mean * 16 + 255 * 255) / (2 * 255 * 255) {
        0 => None,
        8.. => Some(Blend::Opaque),
        eighths => Blend::ALL.get(eighths as usize).copied(),
    }
}

/// Converts a texture; `None` if its faces are invisible. `last` caches the last decoded picture, because several textures can share a
/// picture.
fn encode(
    texture: &Texture,
    options: &TextureOptions,
    last: &mut Option<(Arc<Vec<u8>>, Picture)>,
) -> Result<Option<(Vec<u8>, Report)>, PictureError> {
    let sampler = Sampler {
        filter: options.filter.unwrap_or(texture.sampler.filter),
        ..texture.sampler
    };
    let converted = |picture: &Picture| {
        let (cutoff, blend) = match texture.opacity {
            None => (texture.cutoff, Some(Blend::Opaque)),
            Some(opacity) => {
                let cutoff = texture.cutoff.unwrap_or(INVISIBLE);
                (Some(cutoff), share(opacity, picture, cutoff))
            }
        };
        let Some(blend) = options.blend.or(blend) else {
            return Ok(None);
        };
        let options = Options {
            format: options.format.unwrap_or_default(),
            largest_side: options.largest_side,
            sampler,
            cutoff,
            blend,
        };
        convert(picture, &options).map(Some)
    };
    match &texture.content {
        Content::White => converted(&Picture {
            size: [MIN_SIDE; 2],
            texels: vec![[255; 4]; (MIN_SIDE * MIN_SIDE) as usize],
        }),
        Content::Picture(file) => {
            if !matches!(last, Some((known, _)) if Arc::ptr_eq(known, file)) {
                *last = Some((file.clone(), Picture::decode(file)?));
            }
            let Some((_, picture)) = last else {
                return Err(PictureError::new("a picture", "none"));
            };
            converted(picture)
        }
        Content::Board(bytes) => {
            let board = texture::Texture::new_checked(bytes);
            let board = board.map_err(|error| PictureError::new("a texture", error.to_string()))?;
            let side = options.largest_side;
            again(&board, options.format, side, sampler, options.blend).map(Some)
        }
    }
}

/// For each face with a texture, the whole repeats that are subtracted from its coordinates, which
/// keeps them small. Faces that share texture coordinates subtract the same number, so that they
/// still share vertices: the largest even number up to their smallest coordinate, because two
/// repeats are one period of a mirrored texture. Coordinates of clamped textures remain unchanged.
fn bases(polygons: &Polygons, textures: &Textures) -> Vec<[f64; 2]> {
    let mut entries: HashMap<(u8, [u64; 2]), u32> = HashMap::new();
    let mut sets = Sets::default();
    let mut least: Vec<[f64; 2]> = Vec::new();
    let first_of: Vec<Option<u32>> = polygons
        .faces
        .iter()
        .map(|face| {
            if textures.number(polygons, face) == 0 || is_white(polygons, face) {
                return None;
            }
            let mut first = None;
            for corner in polygons.corners_of(face) {
                let coordinates = polygons.coordinates[corner.coordinates as usize];
                // The addition turns −0 into +0.
                let key = (face.texture, coordinates.map(|c| (c + 0.0).to_bits()));
                let entry = *entries.entry(key).or_insert_with(|| {
                    least.push(coordinates);
                    sets.add()
                });
                sets.join(entry, *first.get_or_insert(entry));
            }
            first
        })
        .collect();
    for entry in 0..least.len() as u32 {
        let of_entry = least[entry as usize];
        let of_set = &mut least[sets.find(entry) as usize];
        for (least, c) in of_set.iter_mut().zip(of_entry) {
            *least = least.min(c);
        }
    }
    let faces = polygons.faces.iter().zip(first_of);
    faces
        .map(|(face, first)| {
            let texture = place(face).and_then(|i| polygons.textures.get(i));
            let (Some(first), Some(texture)) = (first, texture) else {
                return [0.0; 2];
            };
            let least = least[sets.find(first) as usize];
            [0, 1].map(|axis| match texture.sampler.wrap[axis] {
                Wrap::Clamp => 0.0,
                Wrap::Repeat | Wrap::Mirror => 2.0 * (least[axis] / 2.0).floor(),
            })
        })
        .collect()
}

/// A disjoint-set forest.
#[derive(Default)]
struct Sets(Vec<u32>);

impl Sets {
    /// Adds a set that contains only the next number.
    fn add(&mut self) -> u32 {
        let number = self.0.len() as u32;
        self.0.push(number);
        number
    }

    /// The representative of the set that contains `number`.
    fn find(&mut self, mut number: u32) -> u32 {
        while self.0[number as usize] != number {
            let above = self.0[self.0[number as usize] as usize];
            self.0[number as usize] = above;
            number = above;
        }
        number
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        // The lower number becomes the representative, so the result does not depend on the order
        // of the calls.
        self.0[a.max(b) as usize] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Options, convert};
    use super::*;
    use crate::error::Location;
    use crate::formats::glm;
    use glint_core::colour::Rgb565;
    use glint_core::mesh::{Attribute, Mesh};
    use glint_core::records::TextureCoordinates;

    /// A picture of 8×8 as a PNG file.
    fn png(opacity: u8) -> Arc<Vec<u8>> {
        let texels = (0..64).map(|i| [4 * i, 255, 0, if i % 2 == 0 { opacity } else { 255 }]);
        let picture = Picture {
            size: [8, 8],
            texels: texels.collect(),
        };
        Arc::new(picture.png().unwrap())
    }

    fn texture(file: &Arc<Vec<u8>>, wrap: Wrap) -> Texture {
        Texture {
            name: "'a.png'".into(),
            content: Content::Picture(file.clone()),
            sampler: Sampler {
                wrap: [wrap; 2],
                ..Sampler::default()
            },
            cutoff: Some(0.5),
            opacity: None,
        }
    }

    /// A square of two triangles with these texture coordinates and this texture.
    fn square(coordinates: [[f64; 2]; 4], texture: Texture) -> Polygons {
        let mut polygons = Polygons::default();
        for point in [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]] {
            polygons.add_point(point, Location::Whole).unwrap();
        }
        for place in coordinates {
            polygons.add_coordinates(place, Location::Whole).unwrap();
        }
        let number = polygons.add_texture(texture).unwrap();
        for corners in [[0, 1, 2], [0, 2, 3]] {
            let corners = corners.map(|i| Corner {
                coordinates: i,
                ..Corner::at(i)
            });
            polygons.add_face(&corners, None, Location::Whole).unwrap();
        }
        for face in &mut polygons.faces {
            face.texture = number;
        }
        polygons.finish().unwrap();
        polygons
    }

    const UNIT: [[f64; 2]; 4] = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];

    fn coordinates_of(mesh: &Mesh) -> Vec<[i32; 2]> {
        let elements = mesh.attribute(Attribute::TextureCoordinates).unwrap();
        let elements = elements.as_chunks().0.iter();
        let elements = elements.map(TextureCoordinates::from_bytes);
        elements.map(|element| [element.s, element.t]).collect()
    }

    #[test]
    fn a_textured_square() {
        let polygons = square(UNIT, texture(&png(0), Wrap::Repeat));
        let (bytes, report) = convert(&polygons, Options::default()).unwrap();
        let mesh = glm::check_file(&bytes).unwrap();
        assert_eq!((report.vertices, report.triangles), (4, 2));
        let one = 1 << 16;
        let mut found = coordinates_of(&mesh);
        found.sort_unstable();
        assert_eq!(found, [[0, 0], [0, one], [one, 0], [one, one]]);
        let chunk = mesh.chunks().next().unwrap();
        let mut triangles = chunk.triangles();
        assert!(triangles.all(|t| t.texture == 1 && t.colour == Rgb565::WHITE));
        assert!(chunk.vertices().all(|v| v.colour == Rgb565::WHITE));
        let found: Vec<_> = mesh.textures().collect();
        assert_eq!((found.len(), found[0].colour(0, [0, 0])), (1, None));
        let opaque = Rgb565::from_rgb888([4, 255, 0]);
        assert_eq!(found[0].colour(0, [1, 0]), Some(opaque));
        let stated = &report.textures[0];
        assert_eq!((report.textures.len(), stated.report.size), (1, [8; 2]));
        assert_eq!(stated.name, "'a.png'");
        assert_eq!(report.bytes, bytes.len());
    }

    #[test]
    fn opacities_become_eighths() {
        let picture = |opacity: u8| Picture {
            size: [8, 8],
            texels: vec![[9, 9, 9, opacity]; 64],
        };
        for (material, texel, expected) in [
            (255, 255, Some(Blend::Opaque)),
            (255, 128, Some(Blend::ALL[4])),
            (128, 128, Some(Blend::ALL[2])),
            (240, 255, Some(Blend::Opaque)),
            (239, 255, Some(Blend::ALL[7])),
            (16, 255, Some(Blend::ALL[1])),
            (15, 255, None),
            (255, 15, None),
            (0, 255, None),
        ] {
            assert_eq!(
                share(material, &picture(texel), INVISIBLE),
                expected,
                "{material} {texel}"
            );
        }
        // Transparent texels do not count.
        let mut half = picture(255);
        half.texels[..32].fill([0; 4]);
        assert_eq!(share(64, &half, INVISIBLE), Some(Blend::ALL[2]));
    }

    #[test]
    fn blended_faces_come_last_and_invisible_ones_are_left_out() {
        let mut polygons = square(UNIT, texture(&png(255), Wrap::Repeat));
        let numbers = [128, 3, 255].map(|opacity| polygons.white(opacity).unwrap());
        assert_eq!(polygons.white(3).unwrap(), numbers[1]);
        let corners: Vec<Corner> = polygons.corners[..3].to_vec();
        for number in numbers {
            for _ in 0..2 {
                let corners = corners.clone().into_iter().map(|corner| Corner {
                    coordinates: Corner::NO_COORDINATES,
                    ..corner
                });
                let corners: Vec<_> = corners.collect();
                polygons.add_face(&corners, None, Location::Whole).unwrap();
                polygons.faces.last_mut().unwrap().texture = number;
            }
        }
        polygons.faces.reverse();
        let (bytes, report) = convert(&polygons, Options::default()).unwrap();
        let mesh = glm::check(&bytes).unwrap();
        let blends: Vec<_> = mesh.textures().map(|texture| texture.blend()).collect();
        assert_eq!(blends, [Blend::Opaque, Blend::ALL[4], Blend::Opaque]);
        let triangles = mesh
            .chunks()
            .flat_map(|chunk| chunk.triangles().collect::<Vec<_>>());
        let textures: Vec<_> = triangles.map(|triangle| triangle.texture).collect();
        assert_eq!(textures.len(), 6);
        assert_eq!(textures[4..], [2, 2]);
        let remark =
            "2 faces are less than a sixteenth opaque: they are left out; `--blend` shows them";
        assert_eq!(report.remarks, [remark]);
        let reported: Vec<_> = report.textures.iter().map(|one| one.report.blend).collect();
        assert_eq!(reported, ["none", "4", "none"]);
        let mut added = Options::default();
        added.textures.blend = Some(Blend::Additive);
        // Additive blending also keeps the faces that would otherwise be invisible.
        let (bytes, _) = convert(&polygons, added).unwrap();
        let mesh = glm::check(&bytes).unwrap();
        let blends: Vec<_> = mesh.textures().map(|texture| texture.blend()).collect();
        assert_eq!(blends, [Blend::Additive; 4]);
    }

    #[test]
    fn without_textures_the_mesh_is_as_before() {
        let file = png(0);
        let mut left_out = Options::default();
        left_out.textures.left_out = true;
        let textured = square(UNIT, texture(&file, Wrap::Repeat));
        let mut plain = textured.clone();
        plain.faces.iter_mut().for_each(|face| face.texture = 0);
        plain.textures.clear();
        let expected = convert(&plain, Options::default()).unwrap().0;
        assert!(convert(&textured, left_out).unwrap().0 == expected);
        // A broken picture, and a corner without coordinates.
        let broken = square(UNIT, texture(&Arc::new(file[..40].to_vec()), Wrap::Repeat));
        let (bytes, report) = convert(&broken, Options::default()).unwrap();
        assert!(bytes == expected);
        let start = "texture 'a.png': expected a PNG file without damage, found ";
        assert_eq!(report.remarks.len(), 1);
        assert!(report.remarks[0].starts_with(start), "{report:?}");
        let mut partly = textured.clone();
        for corner in &mut partly.corners {
            corner.coordinates = Corner::NO_COORDINATES;
        }
        let (bytes, report) = convert(&partly, Options::default()).unwrap();
        assert!(bytes == expected);
        assert_eq!(
            report.remarks,
            ["2 faces have a texture and no texture coordinates: they keep their own colours"]
        );
    }

    #[test]
    fn whole_repeats_are_left_out_where_they_repeat() {
        let file = png(255);
        let found = |offset: f64, wrap| {
            let moved = UNIT.map(|coordinates| coordinates.map(|c| c / 4.0 + offset));
            let polygons = square(moved, texture(&file, wrap));
            let (bytes, report) = convert(&polygons, Options::default()).unwrap();
            let mesh = glm::check(&bytes).unwrap();
            assert_eq!(mesh.vertex_count(), 4);
            let found = coordinates_of(&mesh);
            let least = found.iter().flatten().min().copied();
            (least.unwrap(), report.remarks)
        };
        let one = 1 << 16;
        for wrap in [Wrap::Repeat, Wrap::Mirror] {
            for (offset, least) in [(0.0, 0), (0.5, one / 2), (-0.25, 2 * one - one / 4)] {
                assert_eq!(found(offset, wrap), (least, vec![]), "{offset}");
            }
            assert_eq!(found(1e9, wrap), (0, vec![]));
            assert_eq!(found(1e9 + 1.0, wrap), (one, vec![]));
        }
        assert_eq!(found(-0.25, Wrap::Clamp), (-one / 4, vec![]));
        let limited = "2 faces have texture coordinates beyond 32768 repeats, which are clamped";
        assert_eq!(found(1e9, Wrap::Clamp), (i32::MAX, vec![limited.into()]));
    }

    #[test]
    fn a_thousand_million_repeats_on_a_face_are_limited() {
        for c in [1e9, 1e300, f64::MAX] {
            let coordinates = [[-c, 0.0], [c, 0.0], [c, c], [0.0, c]];
            let polygons = square(coordinates, texture(&png(255), Wrap::Repeat));
            let (bytes, report) = convert(&polygons, Options::default()).unwrap();
            assert!(coordinates_of(&glm::check(&bytes).unwrap()).contains(&[i32::MAX; 2]));
            assert_eq!(report.remarks.len(), 1);
        }
    }

    #[test]
    fn vertices_are_split_where_coordinates_differ() {
        let mut polygons = square(UNIT, texture(&png(255), Wrap::Repeat));
        let seam = polygons.add_coordinates([0.5, 0.5], Location::Whole);
        // This corner belongs to both triangles.
        polygons.corners[0].coordinates = seam.unwrap();
        let (_, report) = convert(&polygons, Options::default()).unwrap();
        assert_eq!(report.vertices, 5);
        polygons.faces[0].texture = 0;
        let (_, report) = convert(&polygons, Options::default()).unwrap();
        // The vertices of the untextured triangle have another colour, so they are not shared.
        assert_eq!(report.vertices, 6);
    }

    #[test]
    fn options_and_meshes_in_memory() {
        let polygons = square(UNIT, texture(&png(0), Wrap::Mirror));
        let (bytes, _) = convert(&polygons, Options::default()).unwrap();
        let again = glm::parse(&bytes).unwrap();
        let (kept, report) = convert(&again, Options::default()).unwrap();
        assert!(kept == bytes);
        assert_eq!(report.textures[0].name, "1");
        let mut smaller = Options::default();
        smaller.textures.format = Some(Format::Palette16);
        smaller.textures.filter = Some(Filter::Bilinear);
        for polygons in [polygons, again] {
            let (bytes, _) = convert(&polygons, smaller).unwrap();
            let mesh = glm::check(&bytes).unwrap();
            let texture = mesh.textures().next().unwrap();
            assert_eq!(texture.format(), Format::Palette16);
            assert_eq!(texture.sampler().filter, Filter::Bilinear);
            assert_eq!(texture.sampler().wrap, [Wrap::Mirror; 2]);
            assert_eq!(texture.colour(0, [0, 0]), None);
            assert!(texture.colour(0, [1, 0]).is_some());
        }
    }

    #[test]
    fn only_used_textures_are_kept_and_their_bytes_are_limited() {
        let large = Picture {
            size: [1024, 1024],
            texels: vec![[9; 4]; 1 << 20],
        };
        let mut polygons = square(UNIT, texture(&png(255), Wrap::Repeat));
        let file = Arc::new(large.png().unwrap());
        for _ in 0..12 {
            polygons.add_texture(texture(&file, Wrap::Repeat)).unwrap();
        }
        let (_, report) = convert(&polygons, Options::default()).unwrap();
        assert_eq!(report.textures.len(), 1);
        for number in 2..=13 {
            let corners: Vec<Corner> = polygons.corners[..3].to_vec();
            polygons.add_face(&corners, None, Location::Whole).unwrap();
            polygons.faces.last_mut().unwrap().texture = number;
        }
        let (bytes, report) = convert(&polygons, Options::default()).unwrap();
        assert!(bytes.len() < MAX_BYTES as usize);
        let sizes: Vec<[u32; 2]> = report.textures.iter().map(|one| one.report.size).collect();
        assert_eq!((sizes.len(), sizes[0], sizes[12]), (13, [8; 2], [512; 2]));
        assert_eq!(
            report.remarks,
            ["textures have at most 512 texels a side, so that they fit a mesh of 33554432 bytes"]
        );
    }
}
