//! Cameras from the command line and from files.

use crate::error::{FormatError, InputError};
use crate::formats::read_file;
use glint_core::camera::View;
use glint_core::fixed::fixed::traits::Fixed;
use glint_core::fixed::{Q32_32, Turns};
use serde::Deserialize;
use std::path::Path;

/// Contents of a view file. `eye` and `near` are in world units; `u`, `v` and `n` are the rows of the camera's basis.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ViewFile {
    eye: [f64; 3],
    u: [f64; 3],
    v: [f64; 3],
    n: [f64; 3],
    half_width: f64,
    near: f64,
}

/// Reads a view: `{"eye":[x,y,z],"u":[..],"v":[..],"n":[..],"half_width":h,"near":z}`.
///
/// # Errors
/// The file cannot be read, has other contents, or [`View::new_checked`] rejects the camera.
pub fn read(path: &Path) -> Result<View, InputError> {
    let bytes = read_file(path)?;
    parse(&bytes).map_err(|error| error.in_path(path))
}

/// Parses the bytes of a view file; see [`read`].
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8]) -> Result<View, FormatError> {
    let file: ViewFile = serde_json::from_slice(bytes).map_err(|error| {
        let form = r#"{"eye":[x,y,z],"u":[..],"v":[..],"n":[..],"half_width":h,"near":z}"#;
        FormatError::whole(form, error.to_string().escape_debug().to_string())
    })?;
    let view = View::new_checked(
        vector(file.eye, "eye")?,
        vector(file.u, "u")?,
        vector(file.v, "v")?,
        vector(file.n, "n")?,
        number(file.half_width, "half_width")?,
        number(file.near, "near")?,
    );
    view.map_err(|error| FormatError::whole("a camera", error.to_string()))
}

fn vector<T: Fixed>(values: [f64; 3], name: &str) -> Result<[T; 3], FormatError> {
    let [x, y, z] = values;
    Ok([number(x, name)?, number(y, name)?, number(z, name)?])
}

/// Converts a value to fixed point, to nearest; an error mentions `name`.
fn number<T: Fixed>(value: f64, name: &str) -> Result<T, FormatError> {
    T::checked_from_num(value).ok_or_else(|| {
        FormatError::whole(
            format!("{name} between {} and {}", T::MIN, T::MAX),
            format!("{value:e}"),
        )
    })
}

/// Camera on a sphere about the origin, from `R,THETA,PHI`: distance and two angles in degrees.
///
/// # Errors
/// The text is not three decimals, or a value is outside the range of [`View::spherical`].
pub fn spherical(text: &str) -> Result<View, FormatError> {
    let refuse = || {
        FormatError::whole(
            "a camera R,THETA,PHI such as 3,30,60",
            crate::error::quote(text.as_bytes()),
        )
    };
    let mut numbers = [Q32_32::ZERO; 3];
    let mut words = text.split(',');
    for number in &mut numbers {
        *number = words
            .next()
            .and_then(|word| word.trim().parse().ok())
            .ok_or_else(refuse)?;
    }
    if words.next().is_some() {
        return Err(refuse());
    }
    let [r, theta, phi] = numbers;
    if !(Q32_32::ZERO..=Q32_32::from_num(180)).contains(&phi) {
        return Err(FormatError::whole(
            "PHI of 0 to 180 degrees",
            phi.to_string(),
        ));
    }
    View::spherical(r, Turns::from_degrees(theta), Turns::from_degrees(phi))
        .map_err(|error| FormatError::whole("a camera", error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str =
        r#"{"eye":[0,-3,0],"u":[1,0,0],"v":[0,0,-1],"n":[0,1,0],"half_width":0.9,"near":0.1}"#;

    #[test]
    fn a_file_is_the_camera_it_says() {
        let view = parse(GOOD.as_bytes()).unwrap();
        assert_eq!(view.eye().map(|c| c.to_num::<f64>()), [0.0, -3.0, 0.0]);
        assert_eq!(view.half_width(), glint_core::camera::DEFAULT_HALF_WIDTH);
        assert_eq!(view.near(), glint_core::camera::DEFAULT_NEAR);
        // The view from the file equals the spherical camera at theta = -90, phi = 90.
        assert_eq!(view, spherical("3,-90,90").unwrap());
    }

    #[test]
    fn refused_files() {
        let cases = [
            ("", "EOF while parsing a value at line 1 column 0"),
            ("[", "EOF while parsing a list"),
            (
                &GOOD.replace("\"near\":0.1", "\"near\":1e999"),
                "number out of range",
            ),
            (&GOOD.replace("\"near\":0.1", "\"near\":1e300"), "1e300"),
            (
                &GOOD.replace("\"near\":0.1", "\"far\":0.1"),
                "unknown field `far`",
            ),
            (&GOOD.replace("[0,1,0]", "[0,1]"), "invalid length 2"),
            (&GOOD.replace("[0,1,0]", "[0,-1,0]"), "u × v = −n"),
            (
                &GOOD.replace("[0,1,0]", "[0,1.001,0]"),
                "n = (0, 1.001, 0): expected length 1",
            ),
            (
                &GOOD.replace("[1,0,0]", "[1,0.001,0]"),
                "expected 0 within 1e-4",
            ),
            (
                &GOOD.replace("[0,-3,0]", "[0,-32.1,0]"),
                "expected within 32 of the origin",
            ),
            (&GOOD.replace("[0,-3,0]", "[0,-1e40,0]"), "-1e40"),
            (&GOOD.replace("0.9", "4.01"), "half_width 4.01"),
            (&GOOD.replace("0.1}", "0.001}"), "near 0.001"),
        ];
        for (text, expected) in cases {
            let message = parse(text.as_bytes()).unwrap_err().to_string();
            assert!(
                message.contains(expected) && !message.contains('\n'),
                "{text}: {message}"
            );
        }
    }

    #[test]
    fn refused_cameras() {
        for text in [
            "", "3", "3,0", "3,0,0,0", "x,0,0", "1.9,0,0", "5.1,0,0", "3,0,181", "3,0,-1",
            "3,nan,0", "1e99,0,0",
        ] {
            assert!(spherical(text).is_err(), "{text}");
        }
        assert!(spherical(" 2, 725.5 ,180").is_ok());
    }
}
