//! Tests of the rounding of colours to RGB565: dithering preserves the mean of slow changes, and does not change colours that RGB565 can
//! represent.

use glint_core::appearance::Appearance;
use glint_core::colour::{Rgb565, Rounding, Shading};
use glint_core::field::Field;
use glint_core::fixed::U4_28;
use glint_core::light::Background;
use glint_core::mesh::Vertex;
use glint_core::picture::Size;
use glint_core::rectangle::{Part, Rectangle};
use glint_core::texture::{Filter, Sampler, Source, Texture, Wrap, encode};
use glint_model::raymarch::{paint, render_field};
use glint_model::triangle::raster::draw;
use glint_model::triangle::setup::Setup;
use glint_model::triangle::shade::Lit;
use glint_model::{FieldSubject, Frame, MeshSubject, Subject};
use glint_vectors::triangles::{FLAT, SIZE, at, set_up};
use glint_vectors::{Camera, Picture, Random};

use crate::cube;

/// Number of steps of each channel; a step is 255/`STEPS` on the monitor.
const STEPS: [f64; 3] = [31.0, 63.0, 31.0];

/// The largest error of the mean of a channel in a block of 8×8 pixels, in 255ths. `exact` has the exact channels of each pixel in steps;
/// blocks with a `None` are skipped.
fn worst_mean(picture: &Picture, exact: &[Option<[f64; 3]>]) -> f64 {
    let width = picture.width as usize;
    let blocks = (0..picture.height as usize / 8).flat_map(|y| (0..width / 8).map(move |x| (x, y)));
    let mut worst = 0.0_f64;
    let mut count = 0;
    for (x, y) in blocks {
        let places = (0..64).map(|i| (8 * y + i / 8) * width + 8 * x + i % 8);
        let mut sums = [0.0; 3];
        let all = places.clone().all(|place| exact[place].is_some());
        if !all {
            continue;
        }
        for place in places {
            let found = Rgb565(picture.colour[place]).channels().map(f64::from);
            let wanted = exact[place].unwrap_or_default();
            for channel in 0..3 {
                sums[channel] += (found[channel] - wanted[channel]) * 255.0 / STEPS[channel];
            }
        }
        count += 1;
        for sum in sums {
            worst = worst.max((sum / 64.0).abs());
        }
    }
    assert!(count > 50, "{count} blocks");
    worst
}

/// Draws a triangle that covers the whole picture, with this light at the corners, with both roundings. Also returns the exact channels of
/// each pixel in steps.
fn ramp(lit: [Lit; 3], depths: [u32; 3]) -> ([Picture; 2], Vec<Option<[f64; 3]>>) {
    let mut vertices =
        [[-40, -30], [700, -30], [-40, 400]].map(|place: [i64; 2]| at(place.map(|x| 256 * x)));
    for (vertex, depth) in vertices.iter_mut().zip(depths) {
        vertex.w = depth;
    }
    let (triangle, Setup { bounds, .. }) = set_up(vertices, SIZE).unwrap();
    // The index of each vertex before the triangle was oriented.
    let order = triangle
        .vertices
        .map(|vertex| vertices.iter().position(|other| *other == vertex).unwrap());
    let setup = Setup::smooth(&triangle, bounds, &order.map(|number| lit[number]));
    let pictures = [Rounding::Dithered, Rounding::Nearest].map(|rounding| {
        let mut picture = Picture::blank(SIZE);
        let mut target = picture.target();
        target.rounding = rounding;
        draw(&setup, Rgb565(0), &mut target);
        picture
    });
    let (width, height) = SIZE;
    let exact = (0..height)
        .flat_map(|y| (0..width).map(move |x| [x, y]))
        .map(|[x, y]| {
            let [x, y] = [x, y].map(|x| f64::from(x) + 0.5);
            let [right, down] = [(x + 40.0) / 740.0, (y + 30.0) / 430.0];
            let parts = [1.0 - right - down, right, down];
            let depth = |k: usize| f64::from(depths[k]);
            let whole: f64 = (0..3).map(|k| parts[k] * depth(k)).sum();
            Some([0, 1, 2].map(|channel| {
                let light =
                    |k: usize| f64::from(lit[k].0[channel]) * [32.0, 64.0, 32.0][channel] / 65536.0;
                (0..3).map(|k| parts[k] * depth(k) * light(k)).sum::<f64>() / whole
            }))
        });
    (pictures, exact.collect())
}

/// Dithering preserves the mean of light that changes slowly over a smooth triangle; without dithering each pixel is rounded to nearest.
#[test]
fn smooth_ramps_keep_their_mean() {
    let mut random = Random(1);
    let mut worst = [0.0_f64; 3];
    for round in 0..120 {
        let depths = match round % 3 {
            0 => [FLAT; 3],
            1 => [0; 3].map(|_| random.integer(1 << 20, (1 << 23) - 1) as u32),
            _ => [0; 3].map(|_| random.integer(1 << 22, (1 << 24) - 256) as u32),
        };
        // The change over the picture: from a small change to all steps of a channel.
        let reach = [512, 4800, 32_768, 63_488][round % 4];
        let start = random.integer(0, 63_488 - reach);
        let lit = [0; 3].map(|_| {
            let light = random.integer(start, start + reach);
            Lit([light, light, light].map(|light| light as u16))
        });
        let (pictures, exact) = ramp(lit, depths);
        let means = pictures
            .each_ref()
            .map(|picture| worst_mean(picture, &exact));
        for (worst, mean) in worst.iter_mut().zip(means) {
            *worst = worst.max(mean);
        }
        for (pixel, exact) in pictures[1].colour.iter().zip(&exact) {
            let found = Rgb565(*pixel).channels().map(f64::from);
            let exact = exact.unwrap();
            for channel in 0..3 {
                worst[2] = worst[2].max((found[channel] - exact[channel]).abs());
            }
        }
    }
    let [dithered, nearest, step] = worst;
    println!(
        "error of the mean: dithered {dithered:.2}, rounded to nearest {nearest:.2} of 255; error of a pixel: {step:.3} steps"
    );
    assert!(dithered <= 1.0 && step <= 0.5 + 1.0 / 31.0 + 43.0 / 1000.0);
    assert!(nearest > 3.0);
}

/// A ramp between colours of 8 bits that are equal in RGB565 is drawn in their colours: the picture has several colours, and their mean
/// changes from block to block.
#[test]
fn ramps_within_a_step_of_rgb565() {
    let corners = [[128, 128, 135], [135, 131, 128], [131, 130, 131]];
    let equal = Rgb565(0x8410);
    assert!(
        corners
            .iter()
            .all(|&corner| Rgb565::from_rgb888(corner) == equal)
    );
    let lit = corners.map(|corner| {
        let vertex = Vertex::default().with_rgb888(corner);
        Lit::new(Rgb565::with_fractions(vertex.rgb888()), [256; 3])
    });
    let ([dithered, _], exact) = ramp(lit, [FLAT; 3]);
    let worst = worst_mean(&dithered, &exact);
    let earlier = worst_mean(
        &dithered,
        &vec![Some(equal.channels().map(f64::from)); exact.len()],
    );
    println!(
        "error of the mean: {worst:.2} of 255; from the single colour in RGB565: {earlier:.2}"
    );
    assert!(worst < 0.6 && earlier > 2.5, "{worst}, {earlier}");
    let mut colours = dithered.colour.clone();
    colours.sort_unstable();
    colours.dedup();
    assert!(colours.len() > 2, "{colours:04x?}");
}

/// Draws a rectangle that covers the whole picture.
fn rectangle(texture: &[u8], part: u16, colour: Rgb565, rounding: Rounding) -> Picture {
    let part = Part {
        place: [(64 - part) / 2; 2],
        size: [part; 2],
    };
    let rectangle = Rectangle {
        size: [320, 180],
        colour,
        ..Rectangle::new(Texture::new_checked(texture).unwrap(), part, [0; 2])
    };
    let view = Camera::looking([3.0, 2.0, 1.0], [0.0; 3], 0.5, 0.1).rounded();
    Picture::of_frame(&Frame {
        rectangles: &[rectangle],
        rounding,
        ..Frame::new(Subject::Objects(&[]), view, Size::W320)
    })
}

/// A texture of 64×64 texels.
fn texture(filter: Filter, texel: impl Fn(u32, u32) -> Rgb565) -> Vec<u8> {
    let texels = (0..64).flat_map(|y| (0..64).map(move |x| (x, y)));
    encode(&Source {
        size_log2: [6; 2],
        sampler: Sampler {
            wrap: [Wrap::Clamp; 2],
            filter,
        },
        levels: vec![texels.map(|(x, y)| texel(x, y).0).collect()],
        ..Source::default()
    })
    .unwrap()
}

fn grey(number: u32) -> Rgb565 {
    let green = number.min(63) as u16;
    Rgb565((green / 2) << 11 | green << 5 | (green / 2))
}

/// Dithering preserves the mean of enlarged bilinear textures, and of texels of one colour, in light of any colour.
#[test]
fn textures_keep_their_mean() {
    let mut random = Random(2);
    let mut worst = [0.0_f64; 2];
    for round in 0..24 {
        let (across, down) = (random.integer(0, 2) as u32, random.integer(0, 2) as u32);
        let number = |x: u32, y: u32| (across * x + down * y) / 4;
        let texels = texture(Filter::Bilinear, |x, y| grey(number(x, y)));
        let light = match round % 3 {
            0 => Rgb565::WHITE,
            _ => Rgb565(random.bits() as u16),
        };
        let part = 16;
        let [dithered, nearest] = [Rounding::Dithered, Rounding::Nearest]
            .map(|rounding| rectangle(&texels, part, light, rounding));
        let share = [0, 1, 2].map(|i| f64::from(light.channels()[i]) / STEPS[i]);
        let exact: Vec<_> = (0..180)
            .flat_map(|y| (0..320).map(move |x| [x, y]))
            .map(|[x, y]: [u32; 2]| {
                let at = [(x, 320), (y, 180)].map(|(place, side)| {
                    24.0 - 0.5 + (f64::from(place) + 0.5) * f64::from(part) / f64::from(side)
                });
                let [u, v] = at.map(f64::floor);
                let [a, b] = [at[0] - u, at[1] - v];
                Some([0, 1, 2].map(|channel: usize| {
                    let texel = |x: f64, y: f64| {
                        f64::from(grey(number((u + x) as u32, (v + y) as u32)).channels()[channel])
                    };
                    let upper = texel(0.0, 0.0) * (1.0 - a) + texel(1.0, 0.0) * a;
                    let lower = texel(0.0, 1.0) * (1.0 - a) + texel(1.0, 1.0) * a;
                    (upper * (1.0 - b) + lower * b) * share[channel]
                }))
            })
            .collect();
        worst[0] = worst[0].max(worst_mean(&dithered, &exact));
        worst[1] = worst[1].max(worst_mean(&nearest, &exact));
    }
    println!(
        "bilinear, error of the mean: dithered {:.2}, rounded to nearest {:.2} of 255",
        worst[0], worst[1]
    );
    assert!(worst[0] <= 1.0 && worst[1] > 2.0);
    let mut worst = 0.0_f64;
    for _ in 0..64 {
        let [texel, light] = [0; 2].map(|_| Rgb565(random.bits() as u16));
        let texels = texture(Filter::Nearest, |_, _| texel);
        let picture = rectangle(&texels, 16, light, Rounding::Dithered);
        let exact = [0, 1, 2]
            .map(|i| f64::from(texel.channels()[i]) * f64::from(light.channels()[i]) / STEPS[i]);
        worst = worst.max(worst_mean(&picture, &vec![Some(exact); 320 * 180]));
    }
    println!("texels in light, error of the mean: {worst:.2} of 255");
    assert!(worst <= 1.0);
}

/// Dithering preserves the mean of the 8-bit colours of a field with light, fog, sky and occlusion.
#[test]
fn fields_keep_their_mean() {
    let appearance = Appearance {
        background: Some(Background::Sky),
        fog: U4_28::from_num(0.35),
        occlusion: true,
        ..Appearance::default()
    };
    let mut worst = [0.0_f64; 2];
    for text in ["menger:3", "sphere:1.2", "planes:0.4", "cubes:2,0.4"] {
        let field = Field::parse(text).unwrap();
        let subject = FieldSubject {
            field: &field,
            appearance: &appearance,
            quality: Default::default(),
        };
        let view = Camera::looking([2.2, 1.7, 0.3], [0.0; 3], 0.9, 0.1).rounded();
        let frame = Frame::new(Subject::Field(subject), view, Size::W320);
        let constants = frame.constants().unwrap();
        let field = constants.field().unwrap();
        for (worst, rounding) in worst
            .iter_mut()
            .zip([Rounding::Dithered, Rounding::Nearest])
        {
            let mut picture = Picture::blank(SIZE);
            picture.depth.fill(0);
            let mut exact = vec![[0; 3]; picture.colour.len()];
            let mut target = picture.target();
            target.rounding = rounding;
            render_field(
                &field.setup,
                &field.palette,
                &mut target,
                &mut |x, y, end| {
                    exact[(y * SIZE.0 + x) as usize] = paint(&field.setup, &field.palette, end);
                },
            )
            .unwrap();
            // Pixels are compared after the conversion to 8 bits, as on the monitor.
            let width = SIZE.0 as usize;
            for (x, y) in (0..SIZE.1 as usize / 8).flat_map(|y| (0..width / 8).map(move |x| (x, y)))
            {
                let places = (0..64).map(|i| (8 * y + i / 8) * width + 8 * x + i % 8);
                let sums = places.fold([0; 3], |sums: [i32; 3], place| {
                    let shown = Rgb565(picture.colour[place]).to_rgb888();
                    [0, 1, 2].map(|i| sums[i] + i32::from(shown[i]) - i32::from(exact[place][i]))
                });
                for sum in sums {
                    *worst = worst.max(f64::from(sum.abs()) / 64.0);
                }
            }
        }
    }
    println!(
        "field, error of the mean: dithered {:.2}, rounded to nearest {:.2} of 255",
        worst[0], worst[1]
    );
    // Above 1, because colours that change with the depth are related to the thresholds of a block.
    assert!(worst[0] <= 1.06 && worst[1] > 2.0);
}

/// Flat triangles, and texels without light, have the same RGB565 colour in every pixel, with and without dithering.
#[test]
fn exact_colours_are_not_dithered() {
    let mut random = Random(3);
    let view = Camera::looking([3.0, 2.0, 1.0], [0.0; 3], 0.5, 0.1).rounded();
    let subject = MeshSubject::new(cube());
    let flat = Frame::new(Subject::Mesh(subject), view, Size::W320);
    let both = [Rounding::Dithered, Rounding::Nearest];
    let pictures = both.map(|rounding| Picture::of_frame(&Frame { rounding, ..flat }));
    assert!(pictures[0].colour == pictures[1].colour);
    // With smooth shading, dithering changes a channel by at most one step.
    let smooth = MeshSubject {
        shading: Shading::Smooth,
        ..subject
    };
    let smooth = Frame {
        subject: Subject::Mesh(smooth),
        ..flat
    };
    let pictures = both.map(|rounding| Picture::of_frame(&Frame { rounding, ..smooth }));
    for (dithered, nearest) in pictures[0].colour.iter().zip(&pictures[1].colour) {
        let [dithered, nearest] = [*dithered, *nearest].map(|pixel| Rgb565(pixel).channels());
        assert!((0..3).all(|i| dithered[i].abs_diff(nearest[i]) <= 1));
    }
    for filter in [Filter::Nearest, Filter::Bilinear] {
        for _ in 0..40 {
            let [texel, other] = [0; 2].map(|_| Rgb565(random.bits() as u16));
            // Texels of one colour without light, then white texels in coloured light.
            for (texel, light) in [(texel, Rgb565::WHITE), (Rgb565::WHITE, other)] {
                let texels = texture(filter, |_, _| texel);
                for rounding in both {
                    let picture = rectangle(&texels, 16, light, rounding);
                    let wanted = if light == Rgb565::WHITE { texel } else { light };
                    assert!(picture.colour.iter().all(|pixel| *pixel == wanted.0));
                }
            }
        }
        if filter == Filter::Nearest {
            let noise = texture(filter, |x, y| Rgb565((x * 1021 + y * 4099) as u16));
            let [dithered, nearest] =
                both.map(|rounding| rectangle(&noise, 64, Rgb565::WHITE, rounding));
            assert!(dithered.colour == nearest.colour);
        }
    }
}
