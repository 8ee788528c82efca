//! Cameras from files, and the notations of a camera that only the command line of `glint` accepts.

use crate::error::{FormatError, InputError};
use crate::formats::read_file;
use glint_core::camera::{Lens, Projection, View, ViewError};
use glint_core::choice::Choice;
use glint_core::fixed::fixed::traits::Fixed;
use glint_core::fixed::{Q2_23, Q32_32, Turns};
use glint_core::trig::sin_cos_q30;
use serde::Deserialize;
use std::path::Path;

/// Contents of a camera file. `eye` and `near` are in world units; `u`, `v` and `n` are the rows of the camera's basis.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ViewFile {
    eye: [f64; 3],
    u: [f64; 3],
    v: [f64; 3],
    n: [f64; 3],
    half_width: f64,
    near: f64,
    /// `perspective`, which is the default, or `orthographic`.
    projection: Option<String>,
    /// Half the height of the image plane, by default the height for square pixels.
    half_height: Option<f64>,
    /// Middle of the picture in the image plane along u and v, by default 0.
    middle: Option<[f64; 2]>,
}

/// Reads a view:
/// `{"eye":[x,y,z],"u":[..],"v":[..],"n":[..],"half_width":h,"near":z,"projection":"perspective","half_height":h,"middle":[x,y]}`; by
/// default the projection is perspective, pixels are square, and the middle of the picture is straight ahead.
///
/// # Errors
/// The file cannot be read, has other contents, or [`View::new_checked`] rejects the camera.
pub fn read(path: &Path) -> Result<View, InputError> {
    let bytes = read_file(path)?;
    parse(&bytes).map_err(|error| error.in_path(path))
}

/// Parses the bytes of a camera file; see [`read`].
///
/// # Errors
/// As for [`read`].
pub fn parse(bytes: &[u8]) -> Result<View, FormatError> {
    let file: ViewFile = serde_json::from_slice(bytes).map_err(|error| {
        let form = r#"{"eye":[x,y,z],"u":[..],"v":[..],"n":[..],"half_width":h,"near":z,"projection":"perspective","half_height":h,"middle":[x,y]}"#;
        FormatError::whole(form, error.to_string().escape_debug().to_string())
    })?;
    let projection = file.projection.as_deref().unwrap_or_default();
    let projection = match Projection::from_word(projection) {
        Some(projection) => projection,
        None if projection.is_empty() => Projection::Perspective,
        None => {
            return Err(refuse(
                "a projection, `perspective` or `orthographic`",
                projection,
            ));
        }
    };
    let view = View::new_checked(
        vector(file.eye, "eye")?,
        vector(file.u, "u")?,
        vector(file.v, "v")?,
        vector(file.n, "n")?,
        number(file.half_width, "half_width")?,
        number(file.near, "near")?,
    );
    let view = view.map_err(no_camera)?.with_projection(projection);
    if file.half_height.is_none() && file.middle.is_none() {
        return Ok(view);
    }
    let half_height = match file.half_height {
        Some(half_height) => number(half_height, "half_height")?,
        None => view.lens().half_height(),
    };
    let [x, y] = file.middle.unwrap_or_default();
    let middle = [number(x, "middle")?, number(y, "middle")?];
    let half = [view.half_width(), half_height];
    let lens = Lens::window(projection, half, middle, view.near()).map_err(no_camera)?;
    Ok(view.with_lens(lens))
}

fn vector<T: Fixed>(values: [f64; 3], name: &str) -> Result<[T; 3], FormatError> {
    let [x, y, z] = values;
    Ok([number(x, name)?, number(y, name)?, number(z, name)?])
}

/// Rounds a value to the nearest fixed-point number. An error states `name`, the name of the value.
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
    let numbers = decimals(text).and_then(|numbers| <[Q32_32; 3]>::try_from(numbers).ok());
    let [r, theta, phi] =
        numbers.ok_or_else(|| refuse("a camera R,THETA,PHI such as 3,30,60", text))?;
    if !(Q32_32::ZERO..=Q32_32::from_num(180)).contains(&phi) {
        return Err(FormatError::whole(
            "PHI of 0 to 180 degrees",
            phi.to_string(),
        ));
    }
    View::spherical(r, Turns::from_degrees(theta), Turns::from_degrees(phi)).map_err(no_camera)
}

/// Free camera from `EX,EY,EZ,YAW,PITCH` or `EX,EY,EZ,YAW,PITCH,ROLL`: eye, and angles in degrees as in [`View::look`].
///
/// # Errors
/// The text is not five or six decimals, or the eye is too far from the origin.
pub fn look(text: &str) -> Result<View, FormatError> {
    let numbers = decimals(text).unwrap_or_default();
    let (eye, angles) = match *numbers.as_slice() {
        [ex, ey, ez, yaw, pitch] => ([ex, ey, ez], [yaw, pitch, Q32_32::ZERO]),
        [ex, ey, ez, yaw, pitch, roll] => ([ex, ey, ez], [yaw, pitch, roll]),
        _ => {
            return Err(refuse(
                "a camera EX,EY,EZ,YAW,PITCH[,ROLL] such as 0,-3,1,0,20",
                text,
            ));
        }
    };
    let [yaw, pitch, roll] = angles.map(Turns::from_degrees);
    View::look(eye, yaw, pitch, roll).map_err(no_camera)
}

/// Returns the camera after a rotation by `by` about the z axis through the origin, from the x axis
/// towards the y axis. A rotation by 0 returns `view` unchanged.
///
/// # Errors
/// The eye is at the maximum distance from the origin, and rounding moves it beyond the limit.
pub fn turned(view: &View, by: Turns) -> Result<View, FormatError> {
    let (sin, cos) = sin_cos_q30(by);
    let [sin, cos] = [sin, cos].map(|x| i128::from(x.to_bits()));
    // Rounds to nearest. The bits of both coordinates are below 2^38 in magnitude, so the products
    // fit.
    let rotate = |x: i64, y: i64| {
        let [x, y] = [x, y].map(i128::from);
        [cos * x - sin * y, sin * x + cos * y].map(|sum| ((sum + (1 << 29)) >> 30) as i64)
    };
    let eye = |[x, y, z]: [Q32_32; 3]| {
        let [x, y] = rotate(x.to_bits(), y.to_bits()).map(Q32_32::from_bits);
        [x, y, z]
    };
    let row = |[x, y, z]: [Q2_23; 3]| {
        let turned = rotate(x.to_bits().into(), y.to_bits().into());
        let [x, y] = turned.map(|bits| Q2_23::from_bits(bits as i32));
        [x, y, z]
    };
    let turned = View::new_checked(
        eye(view.eye()),
        row(view.u()),
        row(view.v()),
        row(view.n()),
        view.half_width(),
        view.near(),
    );
    turned
        .map(|turned| turned.with_lens_of(view))
        .map_err(no_camera)
}

/// Parses comma-separated decimals.
fn decimals(text: &str) -> Option<Vec<Q32_32>> {
    text.split(',')
        .map(|word| word.trim().parse().ok())
        .collect()
}

fn refuse(expected: &str, text: &str) -> FormatError {
    FormatError::whole(expected, crate::error::quote(text.as_bytes()))
}

fn no_camera(error: ViewError) -> FormatError {
    FormatError::whole("a camera", error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glint_core::fixed::U8_28;

    const GOOD: &str =
        r#"{"eye":[0,-3,0],"u":[1,0,0],"v":[0,0,-1],"n":[0,1,0],"half_width":0.9,"near":0.1}"#;

    #[test]
    fn a_file_is_the_camera_it_says() {
        let view = parse(GOOD.as_bytes()).unwrap();
        assert_eq!(view.eye().map(|c| c.to_num::<f64>()), [0.0, -3.0, 0.0]);
        assert_eq!(view.half_width(), glint_core::camera::DEFAULT_HALF_WIDTH);
        assert_eq!(view.near(), glint_core::camera::DEFAULT_NEAR);
        // The camera from the file equals the spherical camera at theta = -90, phi = 90.
        assert_eq!(view, spherical("3,-90,90").unwrap());
    }

    #[test]
    fn refused_files() {
        for (text, expected) in [
            ("", "EOF while parsing a value at line 1 column 0"),
            ("[", "EOF while parsing a list"),
        ] {
            let message = parse(text.as_bytes()).unwrap_err().to_string();
            assert!(message.contains(expected), "{text}: {message}");
        }
        // The replaced text, its replacement, and a part of the error.
        let cases = r#"
            "near":0.1 → "near":1e999 → number out of range
            "near":0.1 → "near":1e300 → 1e300
            "near":0.1 → "far":0.1 → unknown field `far`
            [0,1,0] → [0,1] → invalid length 2
            [0,1,0] → [0,-1,0] → u × v = −n
            [0,1,0] → [0,1.001,0] → n = (0, 1.001, 0): expected length 1
            [1,0,0] → [1,0.001,0] → expected 0 within 1e-4
            [0,-3,0] → [0,-32.1,0] → expected within 32 of the origin
            [0,-3,0] → [0,-1e40,0] → -1e40
            0.9 → 115.5 → half_width 115.5
            0.1} → 0.001} → near 0.001
            0.1} → 0.1,"projection":"parallel"} → `perspective` or `orthographic`
        "#;
        for case in cases.lines().filter(|case| case.contains('→')) {
            let cells: Vec<_> = case.split('→').map(str::trim).collect();
            let text = GOOD.replace(cells[0], cells[1]);
            let message = parse(text.as_bytes()).unwrap_err().to_string();
            assert!(message.contains(cells[2]), "{text}: {message}");
            assert!(!message.contains('\n'), "{message}");
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

    #[test]
    fn free_look() {
        let view = look("0,-3,0,0,0").unwrap();
        assert_eq!(view, spherical("3,-90,90").unwrap());
        // Half a turn to the right, and a quarter turn about the direction of view, give this
        // camera.
        let turned = look("0,3,0,180,0,90").unwrap();
        let [v, n] = [turned.v(), turned.n()].map(|row| row.map(|c| c.to_num::<f64>()));
        assert_eq!((v, n), ([-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]));
        for (text, expected) in [
            ("0,-3,0,0", "EX,EY,EZ,YAW,PITCH[,ROLL]"),
            ("0,-3,0,0,x", "EX,EY,EZ,YAW,PITCH[,ROLL]"),
            ("0,-33,0,0,0", "within 32 of the origin"),
        ] {
            let message = look(text).unwrap_err().to_string();
            assert!(message.contains(expected), "{text}: {message}");
        }
    }

    #[test]
    fn turns_about_the_z_axis() {
        for first in ["3,0,60", "4,30,90"].map(|text| spherical(text).unwrap()) {
            let angle = Turns::from_degrees(Q32_32::lit("40"));
            let first = first.with_field_of_view(angle).unwrap();
            assert_eq!(turned(&first, Turns(0)).unwrap(), first);
            let mut view = first;
            for _ in 0..4 {
                view = turned(&view, Turns(1 << 30)).unwrap();
            }
            assert_eq!(view, first);
        }
        let quarter = turned(&spherical("3,0,60").unwrap(), Turns(1 << 30)).unwrap();
        assert_eq!(quarter, spherical("3,90,60").unwrap());
        let third = turned(&look("2,1,0.5,-20,10,5").unwrap(), Turns(u32::MAX / 3)).unwrap();
        assert!((third.eye()[2].to_num::<f64>() - 0.5).abs() < 1e-9);
        assert!(third.is_within(3) && !third.is_within(2));
    }

    #[test]
    fn orthographic_projections() {
        let view = spherical("3,0,90").unwrap();
        let parallel = view.with_width(U8_28::lit("3.5")).unwrap();
        let file = GOOD.replace("0.9", "1.75");
        let file = file.replace("0.1}", r#"0.1,"projection":"orthographic"}"#);
        let read = parse(file.as_bytes()).unwrap();
        assert_eq!(read.with_lens_of(&parallel), read);
    }
}
