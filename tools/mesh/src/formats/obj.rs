//! Wavefront OBJ.
//!
//! This parser replaces `tobj`, whose errors have no line number, and which accepts lines of any
//! length, and NaN and infinity as coordinates.

use super::mtl::{self, Ignored, Map, Material};
use super::text::{Line, Lines, component, coordinate, vector};
use crate::error::{FormatError, InputError, Location, MAX_LINE, MAX_REMARKS, quote};
use crate::polygons::{Content, Corner, Polygons, Rgb8, Texture};
use glint_core::texture::{Filter, Sampler, Wrap};
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// Keywords of statements without effect on the drawn surface.
const IGNORED: &[&[u8]] = &[
    b"vp",
    b"g",
    b"o",
    b"s",
    b"mg",
    b"deg",
    b"cstype",
    b"bmat",
    b"step",
    b"parm",
    b"trim",
    b"hole",
    b"scrv",
    b"sp",
    b"end",
    b"con",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"lod",
    b"shadow_obj",
    b"trace_obj",
    b"ctech",
    b"stech",
    b"call",
    b"csh",
    b"maplib",
    b"usemap",
];

/// Keywords of statements that other programs draw, and the remark for each kind.
const UNDRAWN: &[(&[&[u8]], &str)] = &[
    (&[b"l", b"p"], "points and lines are ignored"),
    (
        &[b"curv", b"curv2", b"surf"],
        "curves and free-form surfaces are ignored",
    ),
];

/// Opacity below which texels are transparent; a material file does not state a cutoff.
const CUTOFF: f32 = 0.5;

/// Reads a material file or an image file by name; `None` if it does not exist.
pub type Materials<'a> = dyn FnMut(&str) -> Option<Vec<u8>> + 'a;

/// An error in an OBJ or in its material file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ObjError {
    /// The error is in the OBJ.
    Obj(FormatError),
    /// The error is in a material file.
    Mtl(InputError),
}

impl From<FormatError> for ObjError {
    fn from(error: FormatError) -> Self {
        Self::Obj(error)
    }
}

/// Parses an OBJ. Supports faces with any number of corners, indices from the start or (negative) from the end, normals, vertex
/// colours (`v x y z r g b`, up to 1 or up to 255), texture coordinates, and the diffuse colour (`Kd`) and texture (`map_Kd`) of
/// materials. Lines, points and curves are skipped.
///
/// # Errors
/// The first violation of the format, with its line.
pub fn parse(text: &[u8], materials: &mut Materials) -> Result<Polygons, ObjError> {
    let mut reader = Reader::default();
    let mut lines = Lines::new(text);
    while let Some(line) = lines.next_line()? {
        let joined = join_continued(line, &mut lines)?;
        reader.statement(
            Line {
                number: line.number,
                text: &joined,
            },
            materials,
        )?;
    }
    Ok(reader.finish()?)
}

/// Joins a line that ends in a backslash with the next line.
fn join_continued<'a>(
    first: Line<'a>,
    lines: &mut Lines<'a>,
) -> Result<Cow<'a, [u8]>, FormatError> {
    let mut joined = Cow::Borrowed(first.text);
    while let Some(start) = joined.strip_suffix(b"\\") {
        let Some(next) = lines.next_line()? else {
            break;
        };
        let start = start.len();
        let owned = joined.to_mut();
        owned[start] = b' ';
        owned.extend_from_slice(next.text);
        if owned.len() > MAX_LINE {
            return Err(FormatError::new(
                first.place(),
                format!("a continued line of at most {MAX_LINE} bytes"),
                "a longer one",
            ));
        }
    }
    Ok(joined)
}

#[derive(Default)]
struct Reader {
    polygons: Polygons,
    /// Colours of the points as in the file. Only at the end of the file is it known whether 1 or
    /// 255 is full intensity.
    point_colours: Vec<Option<[f32; 3]>>,
    materials: HashMap<Vec<u8>, Material>,
    colour: Option<Rgb8>,
    /// Number of the current texture; 0 for none.
    texture: u8,
    /// Whether the current texture needs texture coordinates.
    has_picture: bool,
    /// The numbers of the textures that were requested, by their maps and opacities; 0 for a texture that cannot be read.
    textures: HashMap<(Map, Option<u8>), u8>,
    /// The image files that were requested.
    pictures: HashMap<Vec<u8>, Option<Arc<Vec<u8>>>>,
    corners: Vec<Corner>,
    /// Unknown keywords that already have a remark.
    skipped: Vec<Vec<u8>>,
    /// The kinds of [`UNDRAWN`] statements that already have a remark.
    undrawn: [bool; UNDRAWN.len()],
    /// Material files that were requested. Each file is read once.
    libraries: HashSet<Vec<u8>>,
}

impl Reader {
    fn statement(&mut self, line: Line, materials: &mut Materials) -> Result<(), ObjError> {
        let mut words = line.words().take_while(|word| !word.starts_with(b"#"));
        let Some(keyword) = words.next() else {
            return Ok(());
        };
        let place = line.place();
        match keyword {
            b"v" => self.vertex(&mut words, place)?,
            b"vn" => {
                let normal = vector(&mut words, "normal", place, component)?;
                self.polygons.add_normal(normal, place)?;
            }
            b"f" | b"fo" => self.face(&mut words, place)?,
            b"vt" => self.coordinates(&mut words, place)?,
            b"usemtl" => self.material(rest_of(line), materials)?,
            b"mtllib" => self.library(rest_of(line), materials)?,
            _ if IGNORED.contains(&keyword) => {}
            _ if self.is_undrawn(keyword) => {}
            _ if keyword.iter().all(u8::is_ascii_graphic) => self.skip(keyword, place),
            _ => {
                return Err(FormatError::new(
                    place,
                    "an OBJ statement such as v, vn or f",
                    quote(keyword),
                )
                .into());
            }
        }
        Ok(())
    }

    /// Whether other programs draw a statement. The first statement of each kind adds a remark.
    fn is_undrawn(&mut self, keyword: &[u8]) -> bool {
        let mut kinds = UNDRAWN.iter().enumerate();
        let Some((kind, (_, remark))) = kinds.find(|(_, (words, _))| words.contains(&keyword))
        else {
            return false;
        };
        if !std::mem::replace(&mut self.undrawn[kind], true) {
            self.polygons.remark(*remark);
        }
        true
    }

    /// Skips an unknown statement; the first occurrence of its keyword adds a remark.
    fn skip(&mut self, keyword: &[u8], place: Location) {
        if self.skipped.len() < MAX_REMARKS && !self.skipped.iter().any(|known| known == keyword) {
            self.skipped.push(keyword.to_vec());
            let text = format!("{place}the unknown statement {} is skipped", quote(keyword));
            self.polygons.remark(text);
        }
    }

    fn vertex<'a>(
        &mut self,
        words: &mut impl Iterator<Item = &'a [u8]>,
        place: Location,
    ) -> Result<(), FormatError> {
        let point = vector(words, "vertex", place, coordinate)?;
        let mut extra = [0.0; 4];
        let mut count = 0;
        for word in words {
            if count == extra.len() {
                return Err(FormatError::new(
                    place,
                    "at most seven numbers of a vertex",
                    "more",
                ));
            }
            extra[count] = component(word, place)?;
            count += 1;
        }
        let colour = match count {
            // A single number after x, y and z is a weight, which is used only by curves.
            0 | 1 => None,
            // Three numbers after x, y and z are a colour. A fourth number is an opacity, which is ignored.
            3 | 4 => Some([extra[0] as f32, extra[1] as f32, extra[2] as f32]),
            _ => {
                return Err(FormatError::new(
                    place,
                    "three colour components",
                    format!("{count}"),
                ));
            }
        };
        self.polygons.add_point(point, place)?;
        self.point_colours.push(colour);
        Ok(())
    }

    fn coordinates<'a>(
        &mut self,
        words: &mut impl Iterator<Item = &'a [u8]>,
        place: Location,
    ) -> Result<(), FormatError> {
        let expected = "one to three texture coordinates";
        let first = words
            .next()
            .ok_or_else(|| FormatError::new(place, expected, "none"))?;
        let s = component(first, place)?;
        let t = words
            .next()
            .map_or(Ok(0.0), |word| component(word, place))?;
        // In the file, the origin of texture coordinates is the lower left corner.
        self.polygons.add_coordinates([s, 1.0 - t], place)?;
        Ok(())
    }

    /// Selects the material of the next faces.
    fn material(&mut self, name: &[u8], files: &mut Materials) -> Result<(), FormatError> {
        let material = self.materials.get(name).cloned().unwrap_or_default();
        let opacity = material.opacity();
        self.colour = material.colour;
        self.texture = match material.texture {
            None => 0,
            Some(map) => self.texture(map, opacity, files)?,
        };
        self.has_picture = self.texture != 0;
        // Some programs write black as the diffuse colour of a material with a texture, although
        // the texture is meant to be shown unchanged.
        if self.texture != 0 && self.colour == Some(Rgb8([0; 3])) {
            self.colour = None;
        }
        if let (0, Some(opacity)) = (self.texture, opacity) {
            self.texture = self.polygons.white(opacity)?;
        }
        Ok(())
    }

    /// The number of a texture. Returns 0 and adds a remark if its file cannot be read.
    fn texture(
        &mut self,
        map: Map,
        opacity: Option<u8>,
        files: &mut Materials,
    ) -> Result<u8, FormatError> {
        let key = (map, opacity);
        if let Some(&number) = self.textures.get(&key) {
            return Ok(number);
        }
        let map = &key.0;
        let picture = self.pictures.entry(map.file.clone()).or_insert_with(|| {
            let name = std::str::from_utf8(&map.file).ok()?;
            let file = files(name).or_else(|| {
                // A path with separators of another operating system.
                name.contains('\\')
                    .then(|| files(&name.replace('\\', "/")))
                    .flatten()
            });
            file.map(Arc::new)
        });
        let number = match picture {
            Some(picture) => {
                let wrap = if map.is_clamped {
                    Wrap::Clamp
                } else {
                    Wrap::Repeat
                };
                self.polygons.add_texture(Texture {
                    name: quote(&map.file),
                    content: Content::Picture(picture.clone()),
                    sampler: Sampler {
                        wrap: [wrap; 2],
                        filter: Filter::Bilinear,
                    },
                    cutoff: Some(CUTOFF),
                    opacity,
                })?
            }
            None => {
                self.polygons.remark(format!(
                    "no image file {} beside the mesh: its faces keep their own colours",
                    quote(&map.file)
                ));
                0
            }
        };
        self.textures.insert(key, number);
        Ok(number)
    }

    fn face<'a>(
        &mut self,
        words: &mut impl Iterator<Item = &'a [u8]>,
        place: Location,
    ) -> Result<(), FormatError> {
        self.corners.clear();
        for word in words {
            let mut parts = word.split(|&b| b == b'/');
            let expected = |what: &str| {
                FormatError::new(
                    place,
                    format!("{what} in a corner v, v/vt, v//vn or v/vt/vn"),
                    quote(word),
                )
            };
            let point = parts
                .next()
                .and_then(|part| index(part, self.polygons.points.len()))
                .ok_or_else(|| expected("a vertex index (1, 2, … or -1, -2, …)"))?;
            let coordinates = match parts.next() {
                None | Some(b"") => Corner::NO_COORDINATES,
                Some(part) => {
                    integer(part).ok_or_else(|| expected("a texture index"))?;
                    // Without a picture the coordinates have no effect, so their range is not
                    // checked.
                    if self.has_picture {
                        index(part, self.polygons.coordinates.len())
                            .unwrap_or(Corner::NO_COORDINATES - 1)
                    } else {
                        Corner::NO_COORDINATES
                    }
                }
            };
            let normal = match parts.next() {
                None | Some(b"") => Corner::NO_NORMAL,
                Some(part) => {
                    integer(part).ok_or_else(|| expected("a normal index"))?;
                    // An index before the first normal becomes an index after the last normal: both
                    // are out of range.
                    index(part, self.polygons.normals.len()).unwrap_or(Corner::NO_NORMAL - 1)
                }
            };
            if parts.next().is_some() {
                return Err(expected("at most three indices"));
            }
            self.corners.push(Corner {
                point,
                normal,
                coordinates,
            });
        }
        let faces = self.polygons.faces.len();
        self.polygons.add_face(&self.corners, self.colour, place)?;
        for face in &mut self.polygons.faces[faces..] {
            face.texture = self.texture;
        }
        Ok(())
    }

    fn library(&mut self, names: &[u8], materials: &mut Materials) -> Result<(), ObjError> {
        if !self.libraries.insert(names.to_vec()) {
            return Ok(());
        }
        // `names` is one file name with spaces, or several file names. If a file with the whole text as its name exists, only
        // that file is read.
        let mut found = false;
        let whole = std::iter::once(names);
        let parts = names
            .split(u8::is_ascii_whitespace)
            .filter(|name| !name.is_empty() && *name != names);
        for name in whole.chain(parts) {
            let Ok(name) = std::str::from_utf8(name) else {
                continue;
            };
            if let Some(text) = materials(name) {
                found = true;
                let ignored = mtl::parse(&text, &mut self.materials)
                    .map_err(|error| ObjError::Mtl(error.in_file(name)))?;
                self.remark_ignored(ignored);
                if name.as_bytes() == names {
                    break;
                }
            }
        }
        if !found {
            self.polygons.remark(format!(
                "no material file {} beside the mesh: its colours are missing",
                quote(names)
            ));
        }
        Ok(())
    }

    fn remark_ignored(&mut self, ignored: Ignored) {
        let Ignored {
            has_options,
            has_opacities,
            has_light,
        } = ignored;
        for (is_ignored, remark) in [
            (
                has_options,
                "options of textures other than -clamp are ignored (map_Kd)",
            ),
            (has_opacities, "textures of opacities are ignored (map_d)"),
            (has_light, "emitted light is ignored (Ke)"),
        ] {
            if is_ignored {
                self.polygons.remark(remark);
            }
        }
    }

    fn finish(mut self) -> Result<Polygons, FormatError> {
        self.polygons.finish()?;
        if self.point_colours.iter().any(Option::is_some) {
            self.polygons.point_colours = Rgb8::from_floats(&self.point_colours);
        }
        Ok(self.polygons)
    }
}

/// The text after the keyword of a line: a name, which may contain spaces.
fn rest_of(line: Line<'_>) -> &[u8] {
    let text = line.text.trim_ascii();
    text[text
        .iter()
        .position(u8::is_ascii_whitespace)
        .unwrap_or(text.len())..]
        .trim_ascii_start()
}

/// Converts an index of the file to an index that counts from 0. In the file `1` is the first and `-1` the last of the `count`
/// elements so far. Returns `None` for zero, for an index before the first element, and for an index beyond 32 bits.
fn index(word: &[u8], count: usize) -> Option<u32> {
    let index = match integer(word)? {
        index @ 1.. => index - 1,
        0 => return None,
        index => i64::try_from(count).ok()?.checked_add(index)?,
    };
    u32::try_from(index)
        .ok()
        .filter(|&index| index != Corner::NO_NORMAL)
}

fn integer(word: &[u8]) -> Option<i64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::text::rows;

    fn read(text: &str) -> Result<Polygons, ObjError> {
        parse(text.as_bytes(), &mut |name| {
            (name == "a b.mtl").then(|| b"newmtl red #1\nKd 1 0 0\n".to_vec())
        })
    }

    fn error(text: &str) -> String {
        match read(text).expect_err("this text is refused") {
            ObjError::Obj(error) => error.to_string(),
            ObjError::Mtl(error) => error.to_string(),
        }
    }

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    #[test]
    fn polygons_and_negative_indices() {
        let polygons = read(&format!("{SQUARE}f 1 2 3 4\nf -4// -3//\\\n -2//\n")).unwrap();
        let points = |i: usize| -> Vec<u32> {
            let corners = polygons.corners_of(&polygons.faces[i]).iter();
            corners.map(|corner| corner.point).collect()
        };
        assert_eq!(points(0), [0, 1, 2, 3]);
        assert_eq!(points(1), [0, 1, 2]);
        assert_eq!(polygons.triangle_count(), 3);
    }

    #[test]
    fn forward_references() {
        assert_eq!(read(&format!("f 1 2 3\n{SQUARE}")).unwrap().faces.len(), 1);
    }

    #[test]
    fn normals_and_textures() {
        let polygons = read(&format!("{SQUARE}vn 0 0 1\nvt 0 0\nf 1/1/1 2/1/-1 3//1\n")).unwrap();
        assert!(polygons.corners.iter().all(|c| c.normal == 0));
        let without = |c: &Corner| c.coordinates == Corner::NO_COORDINATES;
        assert!(polygons.corners.iter().all(without));
        assert_eq!(polygons.coordinates, [[0.0, 1.0]]);
        assert!(polygons.remarks.is_empty());
    }

    #[test]
    fn statements_that_are_not_drawn_have_a_remark() {
        let text = format!(
            "{SQUARE}vt 0 0\nvt 1 0\nl 1 2\np 1\nl 2 3\ncurv 0 1 1 2\nsurf 0 1 0 1 1\nf 1 2 3\n"
        );
        let points = "points and lines are ignored";
        let curves = "curves and free-form surfaces are ignored";
        assert_eq!(read(&text).unwrap().remarks, [points, curves]);
    }

    #[test]
    fn faces_of_two_corners_and_normals_that_do_not_exist() {
        let wrong = "f 1 2\nf 1//2 2//0 3//-2\nf 3/0/1 2/-9/1 1/7/1\nf\n";
        let polygons = read(&format!("{SQUARE}vn 0 0 1\n{wrong}")).unwrap();
        let normals: Vec<u32> = polygons.corners.iter().map(|c| c.normal).collect();
        assert_eq!(normals, [[Corner::NO_NORMAL; 3], [0; 3]].as_flattened());
        assert_eq!(
            polygons.remarks,
            [
                "line 7: 3 corners have a normal that does not exist: it is computed from the faces",
                "line 6: 2 faces of fewer than three corners are skipped",
            ]
        );
        let polygons = read(&format!("{SQUARE}f 1 2 3\nf 1\n")).unwrap();
        let remark = "line 6: a face of fewer than three corners is skipped";
        assert_eq!(polygons.remarks, [remark]);
    }

    #[test]
    fn colours_to_1_and_to_255() {
        for (one, half) in [("1", "0.5"), ("255", "127.5")] {
            let text = format!("v 0 0 0 {one} 0 0\nv 1 0 0 0 {half} 0 1\nv 0 1 0\nf 1 2 3");
            let colours = read(&text).unwrap().point_colours;
            let expected = [Rgb8([255, 0, 0]), Rgb8([0, 128, 0]), Rgb8::DEFAULT];
            assert_eq!(colours, expected);
        }
    }

    #[test]
    fn normals_and_colours_that_are_no_numbers() {
        for word in ["nan", "-nan(ind)", "-1.#IND", "1.#QNAN", "inf"] {
            let normals = format!("vn 0 {word} 1\nvn 0 0 1\nf 1//1 2//2 3//2\n");
            let polygons = read(&format!("{SQUARE}{normals}")).unwrap();
            assert_eq!(polygons.normals, [[0.0; 3], [0.0, 0.0, 1.0]], "{word}");
        }
        let colours = "v 0 0 0 nan 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 -nan(ind)\nf 1 2 3\n";
        let expected = [Rgb8::DEFAULT, Rgb8([255, 0, 0]), Rgb8::DEFAULT];
        assert_eq!(read(colours).unwrap().point_colours, expected);
    }

    #[test]
    fn materials() {
        let faces = "usemtl red #1\nf 1 2 3 # c\nusemtl none\nf 1 2 3\n";
        let polygons = read(&format!("mtllib a b.mtl\n{SQUARE}{faces}")).unwrap();
        assert_eq!(polygons.faces[0].colour, Some(Rgb8([255, 0, 0])));
        assert_eq!(polygons.faces[1].colour, None);
        assert!(polygons.remarks.is_empty());
        let text = format!("mtllib b\n{SQUARE}f 1 2 3\n");
        let mtl = b"newmtl b\nmap_Kd -s 2 b.png\nmap_d b.png\nKe 1 1 1\n";
        let polygons = parse(text.as_bytes(), &mut |_| Some(mtl.to_vec()));
        assert_eq!(
            polygons.unwrap().remarks,
            [
                "options of textures other than -clamp are ignored (map_Kd)",
                "textures of opacities are ignored (map_d)",
                "emitted light is ignored (Ke)",
            ]
        );
        let polygons = read(&format!("mtllib gone.mtl\n{SQUARE}f 1 2 3\n")).unwrap();
        assert_eq!(polygons.remarks.len(), 1);
    }

    #[test]
    fn opacities_of_materials() {
        let mtl = b"newmtl a\nKd 1 0 0\nd 0.5\nnewmtl b\nmap_Kd b.png\nTr 0.8\nnewmtl c\nd 1\n";
        let text = format!(
            "mtllib m\n{SQUARE}vt 0 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1/1 2/1 3/1\nusemtl c\nf 1 2 3\nusemtl a\nf 1/7 2 3\n"
        );
        let polygons = parse(text.as_bytes(), &mut |_| Some(mtl.to_vec())).unwrap();
        let textures = polygons.faces.iter().map(|face| face.texture);
        assert_eq!(textures.collect::<Vec<_>>(), [1, 2, 0, 1]);
        let opacities = polygons.textures.iter().map(|texture| texture.opacity);
        assert_eq!(opacities.collect::<Vec<_>>(), [Some(128), Some(51)]);
        assert_eq!(polygons.textures[0].content, Content::White);
        assert_eq!(polygons.faces[0].colour, Some(Rgb8([255, 0, 0])));
        assert!(polygons.remarks.is_empty(), "{:?}", polygons.remarks);
    }

    const TEXTURED: &str = "vt 0 0\nvt 1 0.25 9\nvt 2\nusemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 2/2 3/-1\n\
         usemtl c\nf 1/1 2/2 3/3\nusemtl d\nf 1/1 2/2 3/3\nusemtl e\nf 1/1 2 3/9\n";

    #[test]
    fn textures_of_materials() {
        let mtl = "newmtl a\nKd 0 0 0\nmap_Kd sub\\a b.png\nnewmtl b\nKd 0 1 0\nmap_Kd -clamp on sub\\a b.png\n\
                   newmtl c\nKd 1 0 0\nmap_Kd gone.png\nnewmtl d\nKd 0 0 0\nnewmtl e\nmap_Kd sub\\a b.png\n";
        let mut read = Vec::new();
        let text = format!("mtllib m\n{SQUARE}{TEXTURED}");
        let polygons = parse(text.as_bytes(), &mut |name| {
            read.push(name.to_owned());
            match name {
                "m" => Some(mtl.into()),
                "sub/a b.png" => Some(b"picture".to_vec()),
                _ => None,
            }
        })
        .unwrap();
        assert_eq!(read, ["m", "sub\\a b.png", "sub/a b.png", "gone.png"]);
        assert_eq!(polygons.coordinates, [[0.0, 1.0], [1.0, 0.75], [2.0, 1.0]]);
        let faces = polygons.faces.iter();
        let faces: Vec<_> = faces.map(|face| (face.texture, face.colour)).collect();
        let [black, red, green] = [[0, 0, 0], [255, 0, 0], [0, 255, 0]].map(|rgb| Some(Rgb8(rgb)));
        let expected = [(1, None), (2, green), (0, red), (0, black), (1, None)];
        assert_eq!(faces, expected);
        let wraps = polygons.textures.iter().map(|one| one.sampler.wrap[0]);
        assert_eq!(wraps.collect::<Vec<_>>(), [Wrap::Repeat, Wrap::Clamp]);
        let coordinates: Vec<u32> = polygons.corners.iter().map(|c| c.coordinates).collect();
        let none = Corner::NO_COORDINATES;
        assert_eq!(coordinates[..6], [0, 1, 2, 0, 1, 2]);
        assert_eq!(coordinates[6..12], [none; 6]);
        assert_eq!(coordinates[12..], [0, none, none]);
        assert_eq!(
            polygons.remarks,
            [
                "no image file 'gone.png' beside the mesh: its faces keep their own colours",
                "line 18: 1 corners have texture coordinates that do not exist: their faces keep their own colours",
            ]
        );
    }

    #[test]
    fn texture_coordinates_that_are_no_numbers() {
        let text = format!("{SQUARE}vt nan 0\nvt 0 inf\nvt 1e300 -1e300\nf 1 2 3\n");
        let polygons = read(&text).unwrap();
        let expected = [[0.0, 1.0], [0.0, 0.0], [1e300, 1e300]];
        assert_eq!(polygons.coordinates, expected);
        let remark = "line 5: 2 texture coordinates are not finite: they become 0";
        assert_eq!(polygons.remarks, [remark]);
        let expected = "line 1: expected one to three texture coordinates, found none";
        assert_eq!(error("vt\n"), expected);
        assert_eq!(error("vt 0 x\n"), "line 1: expected a number, found 'x'");
    }

    #[test]
    fn more_textures_than_numbers() {
        let names: Vec<String> = (0..256).map(|i| format!("m{i}")).collect();
        let material = |name: &String| format!("newmtl {name}\nmap_Kd {name}.png\n");
        let mtl: String = names.iter().map(material).collect();
        let uses = names.iter().map(|name| format!("usemtl {name}\nf 1 2 3\n"));
        let uses: String = uses.collect();
        let text = format!("mtllib m\n{SQUARE}{uses}");
        let parsed = parse(text.as_bytes(), &mut |_| Some(mtl.clone().into_bytes()));
        let Err(ObjError::Obj(error)) = parsed else {
            panic!("256 textures are refused");
        };
        let error = error.to_string();
        assert_eq!(error, "expected at most 255 textures, found more");
    }

    #[test]
    fn errors_name_their_place() {
        // The lines of a file, separated by `;`, and the expected error.
        let cases = "
            v 0 0 0 → expected at least one face, found none
            v 0 0 → line 1: expected three numbers of a vertex, found 2
            ; v 0 nan 0 → line 2: expected a finite number, found 'nan'
            v 1e309 0 0 → line 1: expected a finite number, found '1e309'
            f 0 1 2 → line 1: expected a vertex index (1, 2, … or -1, -2, …) in a corner v, v/vt, v//vn or v/vt/vn, found '0'
            v 0 0 0; f 1 1 9 → line 2: expected a point index below 1, found 8 (counted from 0)
            v 0 0 0; f 1 1 -2 → line 2: expected a vertex index (1, 2, … or -1, -2, …) in a corner v, v/vt, v//vn or v/vt/vn, found '-2'
            v 0 0 0; f 1 1 99999999999999999999 → line 2: expected a vertex index (1, 2, … or -1, -2, …) in a corner v, v/vt, v//vn or v/vt/vn, found '99999999999999999999'
            v 0 0 0; f 1 1 → expected at least one face, found none
            v 0 0 0; f 1//x 1 1 → line 2: expected a normal index in a corner v, v/vt, v//vn or v/vt/vn, found '1//x'
            v 0 0 0; f 1/x 1 1 → line 2: expected a texture index in a corner v, v/vt, v//vn or v/vt/vn, found '1/x'
            v 0 0 0 1 2 → line 1: expected three colour components, found 2
        ";
        for [text, message] in rows(cases) {
            let text = text.replace("; ", "\n") + "\n";
            assert_eq!(error(&text), message, "{text:?}");
        }
        assert_eq!(error(""), "expected at least one face, found none");
        let elf = "line 1: expected an OBJ statement such as v, vn or f, found '\\x7fELF\\x00'";
        assert_eq!(error("\x7fELF\0\n"), elf);
        let long = "line 1: expected a line of at most 65536 bytes, found a longer one";
        assert_eq!(error(&format!("v {}\n", " ".repeat(1 << 20))), long);
        let long = "line 1: expected a continued line of at most 65536 bytes, found a longer one";
        assert_eq!(error(&"f \\\n".repeat(1 << 20)), long);
    }
}
