//! Resizing and mip levels, in linear light.
//!
//! Averages of sRGB values are too dark: an area that is half white and half black reflects as much
//! light as the sRGB value 188, not 128. Therefore sRGB values are converted to intensities of
//! light, averaged, and converted back.

use crate::picture::Picture;
use glint_core::texture::Wrap;
use std::sync::LazyLock;

/// Linear intensities of red, green and blue from 0 to 1, multiplied by the texel's weight, and the
/// weight.
pub type Texel = [f32; 4];

/// A picture in linear light.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// Width and height.
    pub size: [usize; 2],
    /// The texels, row after row.
    pub texels: Vec<Texel>,
}

/// The intensity of each sRGB value (IEC 61966-2-1).
static LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|value| {
        let value = value as f64 / 255.0;
        let linear = if value <= 0.040_45 {
            value / 12.92
        } else {
            ((value + 0.055) / 1.055).powf(2.4)
        };
        linear as f32
    })
});

/// The intensity of an sRGB value, 0 to 1.
pub fn linear(value: u8) -> f32 {
    LINEAR[usize::from(value)]
}

/// The sRGB value of an intensity: 0 to 255, not rounded.
pub fn srgb(linear: f32) -> f32 {
    let linear = linear.clamp(0.0, 1.0);
    let value = if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    };
    255.0 * value
}

/// The sRGB values of a texel with a weight above 0, not rounded.
pub fn colour([red, green, blue, weight]: Texel) -> [f32; 3] {
    [red, green, blue].map(|intensity| srgb(intensity / weight))
}

impl Level {
    /// The picture in linear light, resized. A box filter shrinks a side, and linear interpolation
    /// enlarges a side. With `by_opacity` the weight of a texel is its opacity, so that transparent
    /// texels do not affect colours; otherwise the weight is 1.
    pub fn resized(picture: &Picture, size: [u32; 2], wrap: [Wrap; 2], by_opacity: bool) -> Self {
        let [from_width, from_height] = picture.size.map(|side| side as usize);
        let size = size.map(|side| side as usize);
        let [width, height] = size;
        let across = spread(from_width, width, wrap[0]);
        let down = spread(from_height, height, wrap[1]);
        let linear = &*LINEAR;
        let mut texels = vec![[0.0; 4]; width * height];
        let mut row = vec![[0.0; 4]; width];
        for (source, outputs) in picture.texels.chunks(from_width).zip(&down) {
            row.fill([0.0; 4]);
            for (&[red, green, blue, opacity], parts) in source.iter().zip(&across) {
                let weight = if by_opacity {
                    f32::from(opacity) / 255.0
                } else {
                    1.0
                };
                let [red, green, blue] =
                    [red, green, blue].map(|value| linear[usize::from(value)] * weight);
                for &(x, part) in parts {
                    add(&mut row[x], [red, green, blue, weight], part);
                }
            }
            for &(y, part) in outputs {
                let output = &mut texels[y * width..][..width];
                for (sum, &texel) in output.iter_mut().zip(&row) {
                    add(sum, texel, part);
                }
            }
        }
        Self { size, texels }
    }

    /// The next mip level: half of each side, at least 1. `None` after the level of 1×1.
    pub fn next(&self) -> Option<Self> {
        let [width, height] = self.size;
        if self.size == [1, 1] {
            return None;
        }
        let size = self.size.map(|side| (side / 2).max(1));
        let [x_step, y_step] = [width / size[0], height / size[1]];
        let part = 1.0 / (x_step * y_step) as f32;
        let mut texels = Vec::with_capacity(size[0] * size[1]);
        for y in 0..size[1] {
            for x in 0..size[0] {
                let mut sum = [0.0; 4];
                for row in y * y_step..(y + 1) * y_step {
                    for &texel in &self.texels[row * width + x * x_step..][..x_step] {
                        add(&mut sum, texel, part);
                    }
                }
                texels.push(sum);
            }
        }
        Some(Self { size, texels })
    }
}

fn add(sum: &mut Texel, texel: Texel, part: f32) {
    for (sum, value) in sum.iter_mut().zip(texel) {
        *sum += value * part;
    }
}

/// For each of `from` source texels, the output texels to which it contributes, and its weight in
/// each. The weights of each of the `to` output texels add up to 1.
fn spread(from: usize, to: usize, wrap: Wrap) -> Vec<Vec<(usize, f32)>> {
    let mut spread = vec![Vec::new(); from];
    if to <= from {
        // In units of 1/(from·to) of the side, a source texel has the length `to`, and an output texel the length `from`.
        for (i, outputs) in spread.iter_mut().enumerate() {
            let (mut start, end) = (i * to, (i + 1) * to);
            while start < end {
                let output = start / from;
                let part_end = end.min((output + 1) * from);
                outputs.push((output, (part_end - start) as f32 / from as f32));
                start = part_end;
            }
        }
        return spread;
    }
    let inside = |place: i64| match wrap {
        Wrap::Repeat => place.rem_euclid(from as i64),
        // The mirror image begins with the edge texel, so it is clamped like an edge.
        Wrap::Mirror | Wrap::Clamp => place.clamp(0, from as i64 - 1),
    };
    for output in 0..to {
        let centre = (output as f64 + 0.5) * from as f64 / to as f64 - 0.5;
        let first = centre.floor();
        let part = (centre - first) as f32;
        for (place, part) in [(first as i64, 1.0 - part), (first as i64 + 1, part)] {
            spread[inside(place) as usize].push((output, part));
        }
    }
    spread
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rounded(level: &Level) -> Vec<[u8; 3]> {
        let texels = level.texels.iter();
        texels
            .map(|&texel| colour(texel).map(|c| c.round() as u8))
            .collect()
    }

    #[test]
    fn every_value_survives_the_way_through_linear_light() {
        let all = Picture::drawn([256, 1], |x, _| [x as u8, 0, 255 - x as u8, 255]);
        let level = Level::resized(&all, all.size, [Wrap::Repeat; 2], false);
        let colours = rounded(&level);
        assert!((0..=255).all(|x| colours[usize::from(x)] == [x, 0, 255 - x]));
    }

    #[test]
    fn parts_of_each_output_add_up_to_one() {
        for (from, to) in [
            (1, 8),
            (3, 8),
            (8, 8),
            (9, 8),
            (5000, 1024),
            (8192, 8),
            (3, 1024),
        ] {
            for wrap in Wrap::ALL {
                let mut sums = vec![0.0; to];
                for (output, part) in spread(from, to, wrap).into_iter().flatten() {
                    sums[output] += part;
                }
                assert!(
                    sums.iter().all(|sum| (sum - 1.0_f32).abs() < 1e-4),
                    "{from} {to}"
                );
            }
        }
    }

    #[test]
    fn averages_are_of_light() {
        let stripes = Picture::drawn(
            [16, 8],
            |x, _| if x % 2 == 0 { [255; 4] } else { [0, 0, 0, 255] },
        );
        let half = Level::resized(&stripes, [8, 8], [Wrap::Repeat; 2], false);
        assert!(rounded(&half).iter().all(|&c| c == [188; 3]));
        let next = Level::resized(&stripes, [16, 8], [Wrap::Repeat; 2], false).next();
        let next = next.unwrap();
        assert_eq!(next.size, [8, 4]);
        assert!(rounded(&next).iter().all(|&c| c == [188; 3]));
    }

    #[test]
    fn levels_end_at_one_texel() {
        let white = Picture::drawn([8, 64], |_, _| [255; 4]);
        let mut level = Level::resized(&white, [8, 64], [Wrap::Repeat; 2], false);
        let mut sizes = vec![level.size];
        while let Some(next) = level.next() {
            sizes.push(next.size);
            level = next;
        }
        assert_eq!(sizes[3..], [[1, 8], [1, 4], [1, 2], [1, 1]]);
        assert_eq!(rounded(&level), [[255; 3]]);
    }

    #[test]
    fn transparent_texels_have_no_influence_on_colours() {
        let holes = Picture::drawn([8, 8], |x, _| {
            if x % 2 == 0 {
                [255, 0, 0, 255]
            } else {
                [0, 255, 0, 0]
            }
        });
        let level = Level::resized(&holes, [8, 8], [Wrap::Repeat; 2], true);
        let next = level.next().unwrap();
        assert!(rounded(&next).iter().all(|&c| c == [255, 0, 0]));
        assert!(next.texels.iter().all(|texel| texel[3] == 0.5));
    }

    #[test]
    fn a_side_that_grows_keeps_the_seam_of_repeat() {
        let two = Picture::drawn(
            [2, 1],
            |x, _| if x == 0 { [0, 0, 0, 255] } else { [255; 4] },
        );
        let first = |wrap| rounded(&Level::resized(&two, [8, 8], [wrap; 2], false))[0][0];
        assert!(first(Wrap::Repeat) > 0);
        assert_eq!([first(Wrap::Clamp), first(Wrap::Mirror)], [0, 0]);
    }
}
