//! A mesh as read from a file: points, and polygons with these points as corners.

use crate::error::{FormatError, Location, MAX_POINTS, MAX_POLYGON, MAX_REMARKS, MAX_TRIANGLES};

/// A point or a direction, in the file's unit.
pub type Vector = [f64; 3];

/// A colour: red, green and blue, 0 to 255.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Rgb8(pub [u8; 3]);

impl Rgb8 {
    /// Colour of surfaces without a colour: a light warm grey.
    pub const DEFAULT: Self = Self([0xd8, 0xd8, 0xd0]);

    /// Converts three intensities from 0 to 1; values outside this range saturate. A colour that is not a number counts as none.
    pub fn from_unit(rgb: [f64; 3]) -> Self {
        if rgb.iter().any(|c| c.is_nan()) {
            return Self::DEFAULT;
        }
        Self(rgb.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8))
    }
}

/// One corner of a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corner {
    /// Index into [`Polygons::points`].
    pub point: u32,
    /// Index into [`Polygons::normals`], or [`NO_NORMAL`](Self::NO_NORMAL).
    pub normal: u32,
}

impl Corner {
    /// Index that marks a corner without a normal.
    pub const NO_NORMAL: u32 = u32::MAX;

    /// A corner without a normal.
    pub fn at(point: u32) -> Self {
        Self {
            point,
            normal: Self::NO_NORMAL,
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
    /// Colour of the face, if any.
    pub colour: Option<Rgb8>,
}

/// Points, and polygons with these points as corners.
///
/// [`add_point`](Self::add_point) and [`add_face`](Self::add_face) enforce the limits of [`crate::error`], which bound the
/// memory. Call [`check_indices`](Self::check_indices) before using the polygons.
#[derive(Clone, Debug, Default)]
pub struct Polygons {
    /// The points.
    pub points: Vec<Vector>,
    /// One colour per point, or empty.
    pub point_colours: Vec<Rgb8>,
    /// Normals from the file. Their vectors may have any length; a normal of length 0 counts as none.
    pub normals: Vec<Vector>,
    /// The corners of all faces.
    pub corners: Vec<Corner>,
    /// The faces.
    pub faces: Vec<Face>,
    /// Remarks for the user, such as a missing material file; at most [`MAX_REMARKS`] from a file.
    pub remarks: Vec<String>,
    triangles: usize,
    largest_point: Largest,
    largest_normal: Largest,
}

/// The largest index that a face has used so far, and the position of that face. Faces may use points or normals that come later in the
/// file, so this index is checked at the end of the file.
#[derive(Clone, Copy, Debug, Default)]
struct Largest(Option<(u32, Location)>);

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

    /// Adds a normal and returns its index. A normal that is not a number or infinite counts as none.
    ///
    /// # Errors
    /// There are more than [`MAX_POINTS`] normals.
    pub fn add_normal(&mut self, normal: Vector, place: Location) -> Result<u32, FormatError> {
        let is_valid = normal.iter().all(|c| c.is_finite());
        let normal = if is_valid { normal } else { [0.0; 3] };
        push(&mut self.normals, normal, "normals", place)
    }

    /// Adds a polygon. The indices of its corners may refer to points added later.
    ///
    /// # Errors
    /// The polygon has fewer than three corners or more than [`MAX_POLYGON`], or the mesh more than [`MAX_TRIANGLES`] triangles.
    pub fn add_face(
        &mut self,
        corners: &[Corner],
        colour: Option<Rgb8>,
        place: Location,
    ) -> Result<(), FormatError> {
        let count = corners.len();
        if !(3..=MAX_POLYGON).contains(&count) {
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
        }
        self.faces.push(Face {
            first: self.corners.len() as u32,
            count: count as u32,
            colour,
        });
        self.corners.extend_from_slice(corners);
        Ok(())
    }

    /// Checks that a face exists, and that the points and normals of all corners exist.
    ///
    /// # Errors
    /// There is no face, or an index is out of range; the error has the position of the largest index.
    pub fn check_indices(&self) -> Result<(), FormatError> {
        self.largest_point.check(self.points.len(), "point")?;
        self.largest_normal.check(self.normals.len(), "normal")?;
        if self.faces.is_empty() {
            return Err(FormatError::whole("at least one face", "none"));
        }
        Ok(())
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
fn push(
    list: &mut Vec<Vector>,
    vector: Vector,
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
        let error = polygons.check_indices().unwrap_err();
        assert_eq!(error.place, Location::Line(2));
        assert_eq!(error.found, "7 (counted from 0)");
    }
}
