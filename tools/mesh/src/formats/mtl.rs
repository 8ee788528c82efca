//! Colours and textures of a Wavefront material file.

use super::text::{Lines, any_number, component};
use crate::error::{FormatError, quote};
use crate::polygons::Rgb8;
use std::collections::HashMap;

/// A material.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Material {
    /// The diffuse colour (`Kd`).
    pub colour: Option<Rgb8>,
    /// The texture of the diffuse colour (`map_Kd`).
    pub texture: Option<Map>,
    /// Opacities, 0 to 255, stated by `d` and by `Tr`; `Tr` counts only without `d`.
    opacities: [Option<u8>; 2],
}

impl Material {
    /// Opacity, 0 to 254; `None` for an opaque material.
    pub fn opacity(&self) -> Option<u8> {
        let [dissolve, by_transparency] = self.opacities;
        dissolve
            .or(by_transparency)
            .filter(|&opacity| opacity < 255)
    }
}

/// The texture of a material.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Map {
    /// The name of the image file, which may contain spaces.
    pub file: Vec<u8>,
    /// Whether the texture is clamped (`-clamp on`); otherwise it repeats.
    pub is_clamped: bool,
}

/// Properties of materials that would change the picture, but are ignored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ignored {
    /// Texture options that affect colours, other than `-clamp`.
    pub has_options: bool,
    /// A texture of opacities.
    pub has_opacities: bool,
    /// Emitted light (`Ke`).
    pub has_light: bool,
}

/// Adds the file's materials with their diffuse colours (`Kd`) and textures (`map_Kd`) to
/// `materials`, and skips other statements. Returns which properties were ignored, for a remark.
///
/// # Errors
/// A line is too long, or a `Kd` comes before the first `newmtl` or has no numbers.
pub fn parse(
    text: &[u8],
    materials: &mut HashMap<Vec<u8>, Material>,
) -> Result<Ignored, FormatError> {
    let mut name: Option<Vec<u8>> = None;
    let mut ignored = Ignored::default();
    let mut lines = Lines::new(text);
    while let Some(line) = lines.next_line()? {
        let mut words = line.words();
        match words.next() {
            Some(b"newmtl") => {
                let text = line.text.trim_ascii();
                name = Some(text[b"newmtl".len()..].trim_ascii().to_vec());
            }
            Some(b"Kd") => {
                let place = line.place();
                let name = name
                    .clone()
                    .ok_or_else(|| FormatError::new(place, "newmtl before the first Kd", "none"))?;
                let Some(first) = words.next() else {
                    return Err(FormatError::new(
                        place,
                        "one or three numbers after Kd",
                        quote(line.text),
                    ));
                };
                if matches!(first, b"spectral" | b"xyz") {
                    continue;
                }
                let red = component(first, place)?;
                let mut next = || words.next().map_or(Ok(red), |word| component(word, place));
                let colour = Rgb8::from_unit([red, next()?, next()?]);
                materials.entry(name).or_default().colour = Some(colour);
            }
            Some(b"map_Kd") => {
                let (map, has_options) = map(line.text);
                ignored.has_options |= has_options;
                if let Some(name) = &name {
                    materials.entry(name.clone()).or_default().texture = map;
                }
            }
            Some(b"map_d" | b"map_Tr") => ignored.has_opacities = true,
            Some(keyword @ (b"d" | b"Tr")) => {
                // The word `-halo` may precede the number.
                let number = words.last().and_then(any_number);
                let number = number.filter(|number| !number.is_nan());
                if let (Some(number), Some(name)) = (number, &name) {
                    let by_transparency = keyword == b"Tr";
                    let opacity = if by_transparency {
                        1.0 - number
                    } else {
                        number
                    };
                    let opacity = (opacity.clamp(0.0, 1.0) * 255.0).round() as u8;
                    let material = materials.entry(name.clone()).or_default();
                    material.opacities[usize::from(by_transparency)] = Some(opacity);
                }
            }
            Some(b"Ke") => {
                ignored.has_light |= words.filter_map(any_number).any(|light| light > 0.0);
            }
            _ => {}
        }
    }
    Ok(ignored)
}

/// Parses a texture statement: keyword, options and file name. Returns the texture, `None` without
/// a file name, and whether ignored options would change its colours.
fn map(statement: &[u8]) -> (Option<Map>, bool) {
    let (_, mut rest) = first_word(statement);
    let mut map = Map::default();
    let mut is_ignored = false;
    loop {
        let (option, after) = first_word(rest);
        // Minimum and maximum number of words after an option. Words beyond the minimum belong to
        // the option if they are numbers.
        let (least, most) = match option {
            b"-clamp" | b"-cc" | b"-blendu" | b"-blendv" | b"-imfchan" | b"-type" | b"-texres"
            | b"-boost" | b"-bm" => (1, 1),
            b"-mm" => (2, 2),
            b"-o" | b"-s" | b"-t" => (1, 3),
            _ => break,
        };
        rest = after;
        let mut first = None;
        for count in 0..most {
            let (word, after) = first_word(rest);
            if count >= least && any_number(word).is_none() {
                break;
            }
            first.get_or_insert(word);
            rest = after;
        }
        match (option, first) {
            (b"-clamp", Some(word)) => map.is_clamped = word == b"on",
            // These options do not affect the colours of level 0.
            (b"-cc" | b"-blendu" | b"-blendv" | b"-type" | b"-texres" | b"-boost", _) => {}
            _ => is_ignored = true,
        }
    }
    map.file = rest.trim_ascii().to_vec();
    ((!map.file.is_empty()).then_some(map), is_ignored)
}

/// The first word of a text, and the text after it.
fn first_word(text: &[u8]) -> (&[u8], &[u8]) {
    let text = text.trim_ascii_start();
    let end = text.iter().position(u8::is_ascii_whitespace);
    text.split_at(end.unwrap_or(text.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours() {
        let mut materials = HashMap::new();
        let text = b"# c\nnewmtl a\n Kd 1 0.5 0\nnewmtl b\nKd 1\nnewmtl c\nKd spectral x.rfl\n";
        let ignored = parse(text, &mut materials);
        assert_eq!(ignored, Ok(Ignored::default()));
        let colour = |name: &[u8]| materials.get(name).and_then(|material| material.colour);
        assert_eq!(colour(b"a"), Some(Rgb8([255, 128, 0])));
        assert_eq!(colour(b"b"), Some(Rgb8::WHITE));
        assert_eq!(materials.len(), 2);
        let error = parse(b"\nKd 1 1 1", &mut materials)
            .unwrap_err()
            .to_string();
        let expected = "line 2: expected newmtl before the first Kd, found none";
        assert_eq!(error, expected);
        assert!(parse(b"newmtl a\nKd x", &mut materials).is_err());
    }

    #[test]
    fn textures_and_their_options() {
        for (statement, file, is_clamped, has_options) in [
            ("map_Kd a.png", "a.png", false, false),
            (" map_Kd\ta b.png ", "a b.png", false, false),
            ("map_Kd -clamp on a.png", "a.png", true, false),
            ("map_Kd -clamp off -cc on 1.png", "1.png", false, false),
            ("map_Kd -o 1 2 -s 1 1 1 -mm 0 1 a.png", "a.png", false, true),
            ("map_Kd -s 2 -clamp on 2 b.png", "2 b.png", true, true),
            ("map_Kd -new a.png", "-new a.png", false, false),
        ] {
            let mut materials = HashMap::new();
            let text = format!("newmtl x\n{statement}\n");
            let ignored = parse(text.as_bytes(), &mut materials).unwrap();
            let map = Map {
                file: file.into(),
                is_clamped,
            };
            assert_eq!(materials[&b"x"[..]].texture, Some(map), "{statement}");
            assert_eq!(ignored.has_options, has_options, "{statement}");
        }
        for statement in ["map_Kd", "map_Kd -clamp", "map_Kd -s 1 1 1", "map_Kd -mm"] {
            let mut materials = HashMap::new();
            let text = format!("newmtl x\n{statement}\n");
            parse(text.as_bytes(), &mut materials).unwrap();
            assert_eq!(materials[&b"x"[..]].texture, None, "{statement}");
        }
    }

    #[test]
    fn ignored_properties() {
        for (text, expected) in [
            ("map_Kd -bm 2 x.png", [true, false, false]),
            ("map_d x.png", [false, true, false]),
            ("Ke 0 0.1 0", [false, false, true]),
            ("d 1\nTr 0\nKe 0 0 0\nKs 1 1 1\nd x\nTr\nKe", [false; 3]),
        ] {
            let text = format!("newmtl x\n{text}\n");
            let found = parse(text.as_bytes(), &mut HashMap::new()).unwrap();
            let found = [found.has_options, found.has_opacities, found.has_light];
            assert_eq!(found, expected, "{text}");
        }
    }

    #[test]
    fn opacities() {
        for (text, expected) in [
            ("d 0.5", Some(128)),
            ("d -halo 0.5", Some(128)),
            ("Tr 0.2", Some(204)),
            ("Tr 1\nd 0.2", Some(51)),
            ("d 1\nTr 1", None),
            ("d -3", Some(0)),
            ("d 2\nd x\nTr\nd nan", None),
        ] {
            let mut materials = HashMap::new();
            let text = format!("d 0.1\nnewmtl x\nKd 1 1 1\n{text}\n");
            parse(text.as_bytes(), &mut materials).unwrap();
            assert_eq!(materials[&b"x"[..]].opacity(), expected, "{text}");
        }
    }
}
