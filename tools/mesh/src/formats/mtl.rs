//! Diffuse colours of a Wavefront material file.

use super::text::{Lines, any_number, component};
use crate::error::{FormatError, quote};
use crate::polygons::Rgb8;
use std::collections::HashMap;

/// Properties of materials that change the picture, and are ignored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ignored {
    /// A texture of the diffuse colour (`map_Kd`).
    pub has_texture: bool,
    /// Transparency: an opacity `d` below 1, a transparency `Tr` above 0, or a texture of either.
    pub is_transparent: bool,
    /// Light from the surface (`Ke`).
    pub has_light: bool,
}

/// Adds each material's diffuse colour (`Kd`) to the palette; other statements are skipped. Returns the ignored properties, for a remark.
///
/// # Errors
/// A line is too long, or a `Kd` comes before the first `newmtl` or has no numbers.
pub fn parse(text: &[u8], palette: &mut HashMap<Vec<u8>, Rgb8>) -> Result<Ignored, FormatError> {
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
                    .as_ref()
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
                palette.insert(name.clone(), Rgb8::from_unit([red, next()?, next()?]));
            }
            Some(b"map_Kd") => ignored.has_texture = true,
            Some(b"map_d" | b"map_Tr") => ignored.is_transparent = true,
            Some(b"d") => {
                // The word `-halo` may precede the number.
                let opacity = words.last().and_then(any_number);
                ignored.is_transparent |= opacity.is_some_and(|opacity| opacity < 1.0);
            }
            Some(b"Tr") => {
                let transparency = words.next().and_then(any_number);
                ignored.is_transparent |= transparency.is_some_and(|value| value > 0.0);
            }
            Some(b"Ke") => {
                ignored.has_light |= words.filter_map(any_number).any(|light| light > 0.0);
            }
            _ => {}
        }
    }
    Ok(ignored)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours() {
        let mut palette = HashMap::new();
        let ignored = parse(
            b"# c\nnewmtl a\n Kd 1 0.5 0\nnewmtl b\nKd 1\nnewmtl c\nKd spectral x.rfl\n",
            &mut palette,
        )
        .unwrap();
        assert_eq!(ignored, Ignored::default());
        assert_eq!(palette.get(&b"a"[..]), Some(&Rgb8([255, 128, 0])));
        assert_eq!(palette.get(&b"b"[..]), Some(&Rgb8([255, 255, 255])));
        assert_eq!(palette.len(), 2);
        assert_eq!(
            parse(b"\nKd 1 1 1", &mut palette).unwrap_err().to_string(),
            "line 2: expected newmtl before the first Kd, found none"
        );
        assert!(parse(b"newmtl a\nKd x", &mut palette).is_err());
    }

    #[test]
    fn ignored_properties() {
        for (text, expected) in [
            ("map_Kd x.png", [true, false, false]),
            ("d 0.5", [false, true, false]),
            ("d -halo 0.5", [false, true, false]),
            ("Tr 0.2", [false, true, false]),
            ("map_d x.png", [false, true, false]),
            ("Ke 0 0.1 0", [false, false, true]),
            ("d 1\nTr 0\nKe 0 0 0\nKs 1 1 1\nd x\nTr\nKe", [false; 3]),
        ] {
            let text = format!("newmtl x\n{text}\n");
            let found = parse(text.as_bytes(), &mut HashMap::new()).unwrap();
            let found = [found.has_texture, found.is_transparent, found.has_light];
            assert_eq!(found, expected, "{text}");
        }
    }
}
