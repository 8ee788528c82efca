//! A hall that is seen from inside, a fence with transparent gaps, and a window of glass, with generated textures.

use crate::error::{FormatError, Location};
use crate::polygons::{Content, Corner, Polygons, Rgb8, Texture, Vector};
use glint_core::texture::{Filter, Sampler};
use glint_texture::picture::Picture;
use std::sync::Arc;

/// Half of the width and of the depth of the hall.
const HALF: f64 = 2.0;
/// Height of the hall's walls.
const HEIGHT: f64 = 2.0;
/// Width and height of each picture in texels.
const SIDE: u32 = 64;
/// Width of a window's frame, and half of the width of the bars between its panes, in texels.
const FRAME: u32 = 4;
const BAR: u32 = 2;
/// Opacity of glass, three eighths.
const GLASS: u8 = 96;

/// A floor of tiles and three walls of bricks, without a ceiling; the side at −y is open.
pub fn hall() -> Result<Polygons, FormatError> {
    let mut polygons = Polygons::default();
    let tiles = add_picture(&mut polygons, "tiles", None, tile)?;
    let bricks = add_picture(&mut polygons, "bricks", None, brick)?;
    // The corners run counter-clockwise as seen from inside, from the lower left corner.
    let wall = |[left, right]: [[f64; 2]; 2]| {
        let at = |[x, y]: [f64; 2], z| [x, y, z];
        [
            at(left, 0.0),
            at(right, 0.0),
            at(right, HEIGHT),
            at(left, HEIGHT),
        ]
    };
    let corners = [[-HALF, -HALF], [-HALF, HALF], [HALF, HALF], [HALF, -HALF]];
    for ends in corners.windows(2) {
        let &[left, right] = ends else { continue };
        rectangle(&mut polygons, wall([left, right]), [4.0, 2.0], bricks)?;
    }
    let floor = [corners[0], corners[3], corners[2], corners[1]];
    let floor = floor.map(|[x, y]| [x, y, 0.0]);
    rectangle(&mut polygons, floor, [4.0, 4.0], tiles)?;
    Ok(polygons)
}

/// A fence along the x axis, seen from both sides, whose gaps are transparent texels.
pub fn fence() -> Result<Polygons, FormatError> {
    let mut polygons = Polygons::default();
    let pickets = add_picture(&mut polygons, "pickets", None, picket)?;
    let at = |x: f64, z: f64| [x, 0.0, z];
    for half in [HALF, -HALF] {
        let corners = [at(-half, 0.0), at(half, 0.0), at(half, 1.0), at(-half, 1.0)];
        rectangle(&mut polygons, corners, [4.0, 1.0], pickets)?;
    }
    Ok(polygons)
}

/// A window along the x axis, seen from both sides: four panes of tinted glass in a wooden frame.
pub fn window() -> Result<Polygons, FormatError> {
    /// Start and end of each of the two panes in a row or a column, in texels of the frame's picture.
    const PANES: [[u32; 2]; 2] = [[FRAME, SIDE / 2 - BAR], [SIDE / 2 + BAR, SIDE - FRAME]];
    let mut polygons = Polygons::default();
    let wood = add_picture(&mut polygons, "wood", None, wood)?;
    let glass = add_picture(&mut polygons, "glass", Some(GLASS), pane)?;
    let place = |texel: u32| f64::from(texel) * 2.0 / f64::from(SIDE);
    for side in [1.0, -1.0] {
        let mut add = |[left, right]: [u32; 2], [low, high]: [u32; 2], texture| {
            let at = |x, z| [side * (place(x) - 1.0), 0.0, place(z)];
            let corners = [
                at(left, low),
                at(right, low),
                at(right, high),
                at(left, high),
            ];
            rectangle(&mut polygons, corners, [1.0, 1.0], texture)
        };
        add([0, SIDE], [0, SIDE], wood)?;
        for across in PANES {
            for up in PANES {
                add(across, up, glass)?;
            }
        }
    }
    Ok(polygons)
}

/// Adds a picture as a repeating texture, with an opacity if it is blended. `texel` computes the colour at column and row.
fn add_picture(
    polygons: &mut Polygons,
    name: &str,
    opacity: Option<u8>,
    texel: impl Fn(u32, u32) -> [u8; 4],
) -> Result<u8, FormatError> {
    let picture = Picture::drawn([SIDE; 2], texel).png();
    let picture = picture
        .map_err(|error| FormatError::whole("a picture that can be written", error.to_string()))?;
    polygons.add_texture(Texture {
        name: name.into(),
        content: Content::Picture(Arc::new(picture)),
        sampler: Sampler {
            filter: Filter::Bilinear,
            ..Sampler::default()
        },
        cutoff: Some(0.5),
        opacity,
    })
}

/// Adds a rectangle that repeats its texture as often as stated. Its corners run counter-clockwise
/// from the lower left.
fn rectangle(
    polygons: &mut Polygons,
    corners: [Vector; 4],
    [across, down]: [f64; 2],
    texture: u8,
) -> Result<(), FormatError> {
    let places = [[0.0, down], [across, down], [across, 0.0], [0.0, 0.0]];
    let mut face = Vec::new();
    for (corner, place) in corners.into_iter().zip(places) {
        let point = polygons.add_point(corner, Location::Whole)?;
        let coordinates = polygons.add_coordinates(place, Location::Whole)?;
        face.push(Corner {
            coordinates,
            ..Corner::at(point)
        });
    }
    polygons.add_face(&face, Some(Rgb8::WHITE), Location::Whole)?;
    if let Some(face) = polygons.faces.last_mut() {
        face.texture = texture;
    }
    Ok(())
}

/// Texture of the floor: 2×2 tiles, alternately light and dark.
fn tile(x: u32, y: u32) -> [u8; 4] {
    let half = SIDE / 2;
    if (x % half).min(y % half) == 0 {
        return [70, 66, 62, 255];
    }
    let is_light = (x < half) == (y < half);
    let base = if is_light {
        [196, 188, 172]
    } else {
        [112, 120, 128]
    };
    shaded(base, noise(x / 2, y / 2) % 14)
}

/// Texture of the walls: four rows of two bricks; every other row is offset by half a brick.
fn brick(x: u32, y: u32) -> [u8; 4] {
    let [width, height] = [SIDE / 2, SIDE / 4];
    let row = y / height;
    let along = x + row % 2 * (width / 2);
    if along % width < 2 || y % height < 2 {
        return shaded([176, 168, 156], noise(x, y) % 12);
    }
    let number = noise(along / width % 2, row) % 40;
    shaded([190, 92, 64], number + noise(x, y) % 14)
}

/// Texture of the fence: four pointed pickets on two rails, and transparent gaps.
fn picket(x: u32, y: u32) -> [u8; 4] {
    let width = SIDE / 4;
    let from_middle = (2 * (x % width) + 1).abs_diff(width);
    if from_middle < 11 && 2 * y >= from_middle {
        let edge = if from_middle > 8 { 50 } else { 0 };
        return shaded([236, 230, 214], edge + noise(x, y / 8) % 24);
    }
    let is_rail = (14..20).contains(&y) || (46..52).contains(&y);
    if is_rail {
        return shaded([196, 188, 170], noise(x / 8, y) % 24);
    }
    // Transparent texels have the colour of the pickets, so filtering leaves no fringe at their edges.
    [236, 230, 214, 0]
}

/// Texture of a window's frame, with transparent texels in the place of the panes.
fn wood(x: u32, y: u32) -> [u8; 4] {
    let is_bar = |place: u32| {
        !(FRAME..SIDE - FRAME).contains(&place) || (SIDE / 2 - BAR..SIDE / 2 + BAR).contains(&place)
    };
    let colour = [148, 98, 56];
    if is_bar(x) || is_bar(y) {
        return shaded(colour, noise(x / 8, y) % 28);
    }
    let [r, g, b] = colour;
    [r, g, b, 0]
}

/// Texture of a pane: blue glass with two diagonal gleams.
fn pane(x: u32, y: u32) -> [u8; 4] {
    match (x + y) % SIDE {
        20..26 | 29..31 => [226, 240, 248, 255],
        _ => [122, 176, 206, 255],
    }
}

/// The colour, opaque, with `darker` subtracted from each channel.
fn shaded(colour: [u8; 3], darker: u32) -> [u8; 4] {
    let [r, g, b] = colour.map(|c| c.saturating_sub(darker as u8));
    [r, g, b, 255]
}

/// A pseudo-random number for a texel.
fn noise(x: u32, y: u32) -> u32 {
    let key = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA6B);
    (key ^ key >> 15).wrapping_mul(0xC2B2_AE35) >> 16
}
