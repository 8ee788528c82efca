//! Diffuse colours of a Wavefront material file.

use super::text::{Lines, component};
use crate::error::{FormatError, quote};
use crate::polygons::Rgb8;
use std::collections::HashMap;

/// Adds each material's diffuse colour (`Kd`) to the palette; other statements are skipped. Returns whether a material has a texture of
/// its diffuse colour (`map_Kd`).
///
/// # Errors
/// A line is too long, or a `Kd` comes before the first `newmtl` or has no numbers.
pub fn parse(text: &[u8], palette: &mut HashMap<Vec<u8>, Rgb8>) -> Result<bool, FormatError> {
    let mut name: Option<Vec<u8>> = None;
    let mut has_texture = false;
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
            Some(b"map_Kd") => has_texture = true,
            _ => {}
        }
    }
    Ok(has_texture)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours() {
        let mut palette = HashMap::new();
        assert_eq!(parse(b"newmtl x\nmap_Kd x.png\n", &mut palette), Ok(true));
        let has_texture = parse(
            b"# c\nnewmtl a\n Kd 1 0.5 0\nnewmtl b\nKd 1\nnewmtl c\nKd spectral x.rfl\n",
            &mut palette,
        )
        .unwrap();
        assert!(!has_texture);
        assert_eq!(palette.get(&b"a"[..]), Some(&Rgb8([255, 128, 0])));
        assert_eq!(palette.get(&b"b"[..]), Some(&Rgb8([255, 255, 255])));
        assert_eq!(palette.len(), 2);
        assert_eq!(
            parse(b"\nKd 1 1 1", &mut palette).unwrap_err().to_string(),
            "line 2: expected newmtl before the first Kd, found none"
        );
        assert!(parse(b"newmtl a\nKd x", &mut palette).is_err());
    }
}
