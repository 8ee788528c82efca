//! A mesh as read from a file: points, and polygons with these points as corners.

use crate::error::{
    FormatError, Location, MAX_FILE, MAX_POINTS, MAX_POLYGON, MAX_REMARKS, MAX_TRIANGLES,
};
use glint_core::texture::Sampler;
use std::sync::Arc;

/// A point or a direction, in the file's unit.
pub type Vector = [f64; 3];

/// A colour: red, green and blue, 0 to 255.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Rgb8(pub [u8; 3]);

impl Rgb8 {
    /// White, the colour of a surface that shows its texture unchanged.
    pub const WHITE: Self = Self([255; 3]);
    /// Colour of surfaces without a colour: a light warm grey, which RGB565 represents exactly.
    pub const DEFAULT: Self = Self([0xd6, 0xd7, 0xce]);

    /// Converts three intensities from 0 to 1; values outside this range saturate. A colour with a
    /// NaN counts as missing.
    pub fn from_unit(rgb: [f64; 3]) -> Self {
        if rgb.iter().any(|c| c.is_nan()) {
            return Self::DEFAULT;
        }
        Self(rgb.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8))
    }

    /// Converts all colours of a file that does not state the value of full intensity: the value is
    /// 255 if a component exceeds 1, and 1 otherwise.
    pub fn from_floats(colours: &[Option<[f32; 3]>]) -> Vec<Self> {
        let components = colours.iter().flatten().flatten().copied();
        let largest = components.filter(|c| c.is_finite()).fold(0.0, f32::max);
        let scale = if largest > 1.0 { 1.0 / 255.0 } else { 1.0 };
        let convert = |c: [f32; 3]| Self::from_unit(c.map(|c| f64::from(c) * scale));
        let colours = colours.iter();
        colours
            .map(|colour| colour.map_or(Self::DEFAULT, convert))
            .collect()
    }
}

/// One corner of a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corner {
    /// Index into [`Polygons::points`].
    pub point: u32,
    /// Index into [`Polygons::normals`], or [`NO_NORMAL`](Self::NO_NORMAL).
    pub normal: u32,
    /// Index into [`Polygons::coordinates`], or [`NO_COORDINATES`](Self::NO_COORDINATES).
    pub coordinates: u32,
}

impl Corner {
    /// Index that marks a corner without a normal.
    pub const NO_NORMAL: u32 = u32::MAX;
    /// Index that marks a corner without texture coordinates.
    pub const NO_COORDINATES: u32 = u32::MAX;

    /// A corner without normal and texture coordinates.
    pub fn at(point: u32) -> Self {
        Self {
            point,
            normal: Self::NO_NORMAL,
            coordinates: Self::NO_COORDINATES,
        }
    }
}

/// One polygon: a range of corners, counter-clockwise seen from outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// Index of the first corner in [`Polygons::corners`].
    pub first: u32,
    /// Number of corners, at least 3.
    pub count: u32,
    /// Colour of the face, if any. The colours of its texture are multiplied by it.
    pub colour: Option<Rgb8>,
    /// Number of the texture in [`Polygons::textures`], counted from 1; 0 for none.
    pub texture: u8,
    /// Whether the face is visible from both sides.
    pub double_sided: bool,
}

/// A texture of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The name of its file, or its number in the file of the mesh, for messages.
    pub name: String,
    /// An image file, a texture for a board, or white.
    pub content: Content,
    /// Wrap modes and filter.
    pub sampler: Sampler,
    /// Opacity, 0 to 1, below which texels are transparent; `None` for an opaque texture.
    pub cutoff: Option<f32>,
    /// Opacity of the surfaces, 0 to 255, if they are blended with the picture behind them; the opacity of the texels multiplies it.
    pub opacity: Option<u8>,
}

/// The content of a texture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Content {
    /// The bytes of an image file, not checked.
    Picture(Arc<Vec<u8>>),
    /// A checked texture in a board's memory layout. Its header states wrap modes and filter.
    Board(Vec<u8>),
    /// White everywhere, for surfaces without a picture that are blended with the picture behind them. It needs no texture coordinates.
    White,
}

impl Content {
    fn len(&self) -> usize {
        match self {
            Self::Picture(bytes) => bytes.len(),
            Self::Board(bytes) => bytes.len(),
            Self::White => 0,
        }
    }
}

/// Points, and polygons with these points as corners.
///
/// [`add_point`](Self::add_point) and [`add_face`](Self::add_face) enforce the limits of [`crate::error`], which bound the
/// memory. Call [`finish`](Self::finish) before using the polygons.
#[derive(Clone, Debug, Default)]
pub struct Polygons {
    /// The points of all faces, in the file's unit.
    pub points: Vec<Vector>,
    /// One colour per point, or empty.
    pub point_colours: Vec<Rgb8>,
    /// Normals from the file. Their vectors may have any length; a normal of length 0 counts as none.
    pub normals: Vec<Vector>,
    /// Texture coordinates s to the right and t down from the upper left corner of the texture, in
    /// units of its width and height.
    pub coordinates: Vec<[f64; 2]>,
    /// The textures; at most [`MAX_TEXTURES`].
    pub textures: Vec<Texture>,
    /// The corners of all faces.
    pub corners: Vec<Corner>,
    /// The faces, as ranges of `corners`.
    pub faces: Vec<Face>,
    /// Whether the surface is smooth, if the source states this. With `None`, the surface counts as smooth if all corners have normals.
    pub is_smooth: Option<bool>,
    /// Remarks for the user, such as a missing material file; at most [`MAX_REMARKS`] from a file.
    pub remarks: Vec<String>,
    triangles: usize,
    skipped_faces: Tally,
    invalid_coordinates: Tally,
    largest_point: Largest,
    largest_normal: Largest,
    largest_coordinates: Largest,
}

/// Maximum number of textures of a mesh: a triangle stores the number of its texture in 8 bits.
pub const MAX_TEXTURES: usize = 255;

/// The largest index that a face has used so far, and the position of that face. It is checked at
/// the end of the file, because faces may use points that come later in the file.
#[derive(Clone, Copy, Debug, Default)]
struct Largest(Option<(u32, Location)>);

/// Number of occurrences of a fault, and the position of the first. One remark reports all of them.
#[derive(Clone, Copy, Debug, Default)]
struct Tally(Option<(usize, Location)>);

impl Tally {
    fn count(&mut self, place: Location) {
        let (count, first) = self.0.unwrap_or((0, place));
        self.0 = Some((count + 1, first));
    }
}

impl Largest {
    fn update(&mut self, index: u32, place: Location) {
        if self.0.is_none_or(|(largest, _)| index > largest) {
            self.0 = Some((index, place));
        }
    }

    fn check(self, count: usize, what: &str) -> Result<(), FormatError> {
        match self.0 {
            Some((index, place)) if index as usize >= count => Err(FormatError::new(
                place,
                format!("a {what} index below {count}"),
                format!("{index} (counted from 0)"),
            )),
            _ => Ok(()),
        }
    }
}

impl Polygons {
    /// Adds a remark, unless it already exists or there are [`MAX_REMARKS`] remarks.
    pub fn remark(&mut self, remark: impl Into<String>) {
        let remark = remark.into();
        if self.remarks.len() < MAX_REMARKS && !self.remarks.contains(&remark) {
            self.remarks.push(remark);
        }
    }

    /// Adds a point and returns its index.
    ///
    /// # Errors
    /// There are more than [`MAX_POINTS`] points.
    pub fn add_point(&mut self, point: Vector, place: Location) -> Result<u32, FormatError> {
        push(&mut self.points, point, "points", place)
    }

    /// Adds a normal and returns its index. A normal with an infinite component or a NaN counts as
    /// missing.
    ///
    /// # Errors
    /// There are more than [`MAX_POINTS`] normals.
    pub fn add_normal(&mut self, normal: Vector, place: Location) -> Result<u32, FormatError> {
        let is_valid = normal.iter().all(|c| c.is_finite());
        let normal = if is_valid { normal } else { [0.0; 3] };
        push(&mut self.normals, normal, "normals", place)
    }

    /// Adds texture coordinates and returns their index. Infinite and NaN coordinates become 0, and
    /// add a remark.
    ///
    /// # Errors
    /// There are more than [`MAX_POINTS`] texture coordinates.
    pub fn add_coordinates(
        &mut self,
        coordinates: [f64; 2],
        place: Location,
    ) -> Result<u32, FormatError> {
        let is_valid = coordinates.iter().all(|c| c.is_finite());
        if !is_valid {
            self.invalid_coordinates.count(place);
        }
        let coordinates = coordinates.map(|c| if c.is_finite() { c } else { 0.0 });
        push(
            &mut self.coordinates,
            coordinates,
            "texture coordinates",
            place,
        )
    }

    /// Adds a texture and returns its number, from 1. If the total size of the textures exceeds
    /// [`MAX_FILE`] bytes, the texture is left out, a remark is added, and the number is 0.
    ///
    /// # Errors
    /// There are more than [`MAX_TEXTURES`] textures.
    pub fn add_texture(&mut self, texture: Texture) -> Result<u8, FormatError> {
        let bytes: usize = self.textures.iter().map(|one| one.content.len()).sum();
        if bytes + texture.content.len() > MAX_FILE {
            self.remark(format!(
                "texture {}: expected at most {MAX_FILE} bytes of all textures, found more: its faces keep their own colours",
                texture.name
            ));
            return Ok(0);
        }
        if self.textures.len() >= MAX_TEXTURES {
            let expected = format!("at most {MAX_TEXTURES} textures");
            return Err(FormatError::whole(expected, "more"));
        }
        self.textures.push(texture);
        Ok(self.textures.len() as u8)
    }

    /// Returns the number of a white texture of this opacity, 0 to 255, and adds the texture if it is new.
    ///
    /// # Errors
    /// As for [`add_texture`](Self::add_texture).
    pub fn white(&mut self, opacity: u8) -> Result<u8, FormatError> {
        let texture = Texture {
            name: format!("of opacity {:.2}", f64::from(opacity) / 255.0),
            content: Content::White,
            sampler: Sampler::default(),
            cutoff: None,
            opacity: Some(opacity),
        };
        match self.textures.iter().position(|known| *known == texture) {
            Some(index) => Ok(index as u8 + 1),
            None => self.add_texture(texture),
        }
    }

    /// Adds a polygon. The indices of its corners may refer to points added later. A polygon of fewer than three corners is skipped with
    /// a remark.
    ///
    /// # Errors
    /// The polygon has more than [`MAX_POLYGON`] corners, or the mesh more than [`MAX_TRIANGLES`] triangles.
    pub fn add_face(
        &mut self,
        corners: &[Corner],
        colour: Option<Rgb8>,
        place: Location,
    ) -> Result<(), FormatError> {
        let count = corners.len();
        if count < 3 {
            self.skipped_faces.count(place);
            return Ok(());
        }
        if count > MAX_POLYGON {
            return Err(FormatError::new(
                place,
                format!("a face of 3 to {MAX_POLYGON} corners"),
                format!("{count}"),
            ));
        }
        self.triangles += count - 2;
        if self.triangles > MAX_TRIANGLES {
            return Err(FormatError::new(
                place,
                format!("at most {MAX_TRIANGLES} triangles"),
                "more",
            ));
        }
        for corner in corners {
            self.largest_point.update(corner.point, place);
            if corner.normal != Corner::NO_NORMAL {
                self.largest_normal.update(corner.normal, place);
            }
            if corner.coordinates != Corner::NO_COORDINATES {
                self.largest_coordinates.update(corner.coordinates, place);
            }
        }
        self.faces.push(Face {
            first: self.corners.len() as u32,
            count: count as u32,
            colour,
            texture: 0,
            double_sided: false,
        });
        self.corners.extend_from_slice(corners);
        Ok(())
    }

    /// Checks that the mesh has a face and that the points of all corners exist. Removes indices of
    /// missing normals and texture coordinates. Adds remarks on these indices, on texture
    /// coordinates that are not finite, and on skipped faces.
    ///
    /// # Errors
    /// There is no face, or the index of a point is out of range; the error has the position of the largest index.
    pub fn finish(&mut self) -> Result<(), FormatError> {
        self.largest_point.check(self.points.len(), "point")?;
        if let Err(error) = self.largest_normal.check(self.normals.len(), "normal") {
            let count = self.remove_missing_normals();
            self.remark(format!(
                "{}{count} corners have a normal that does not exist: it is computed from the faces",
                error.place
            ));
        }
        let check = self.largest_coordinates.check(self.coordinates.len(), "");
        if let Err(error) = check {
            let count = self.remove_missing_coordinates();
            self.remark(format!(
                "{}{count} corners have texture coordinates that do not exist: their faces keep their own colours",
                error.place
            ));
        }
        if let Some((count, first)) = self.invalid_coordinates.0 {
            self.remark(format!(
                "{first}{count} texture coordinates are not finite: they become 0"
            ));
        }
        if let Some((count, first)) = self.skipped_faces.0 {
            self.remark(match count {
                1 => format!("{first}a face of fewer than three corners is skipped"),
                _ => format!("{first}{count} faces of fewer than three corners are skipped"),
            });
        }
        if self.faces.is_empty() {
            return Err(FormatError::whole("at least one face", "none"));
        }
        Ok(())
    }

    /// Removes the indices of missing normals, and returns the number of such corners.
    fn remove_missing_normals(&mut self) -> usize {
        let normals = self.normals.len();
        let corners = self.corners.iter_mut();
        let missing = corners.filter(|corner| {
            corner.normal != Corner::NO_NORMAL && corner.normal as usize >= normals
        });
        missing
            .map(|corner| corner.normal = Corner::NO_NORMAL)
            .count()
    }

    /// Removes the indices of missing texture coordinates, and returns the number of such corners.
    fn remove_missing_coordinates(&mut self) -> usize {
        let count = self.coordinates.len();
        let corners = self.corners.iter_mut();
        let missing = corners.filter(|corner| {
            corner.coordinates != Corner::NO_COORDINATES && corner.coordinates as usize >= count
        });
        missing
            .map(|corner| corner.coordinates = Corner::NO_COORDINATES)
            .count()
    }

    /// The corners of a face.
    pub fn corners_of(&self, face: &Face) -> &[Corner] {
        &self.corners[face.first as usize..][..face.count as usize]
    }

    /// The point of a corner.
    pub fn point(&self, corner: Corner) -> Vector {
        self.points[corner.point as usize]
    }

    /// Number of triangles of all faces.
    pub fn triangle_count(&self) -> usize {
        self.triangles
    }
}

/// Appends a vector to a list that holds at most [`MAX_POINTS`], and returns the vector's index.
fn push<const N: usize>(
    list: &mut Vec<[f64; N]>,
    vector: [f64; N],
    name: &str,
    place: Location,
) -> Result<u32, FormatError> {
    if list.len() >= MAX_POINTS {
        return Err(FormatError::new(
            place,
            format!("at most {MAX_POINTS} {name}"),
            "one more",
        ));
    }
    list.push(vector);
    Ok((list.len() - 1) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_index_is_named() {
        let mut polygons = Polygons::default();
        polygons.add_point([0.0; 3], Location::Line(1)).unwrap();
        polygons
            .add_face(
                &[Corner::at(0), Corner::at(7), Corner::at(3)],
                None,
                Location::Line(2),
            )
            .unwrap();
        polygons
            .add_face(
                &[Corner::at(1), Corner::at(0), Corner::at(0)],
                None,
                Location::Line(3),
            )
            .unwrap();
        let error = polygons.finish().unwrap_err();
        assert_eq!(error.place, Location::Line(2));
        assert_eq!(error.found, "7 (counted from 0)");
    }
}
