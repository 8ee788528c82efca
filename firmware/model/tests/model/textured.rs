//! Tests of textures on triangles, compared with exact perspective: positions in the texture, mip levels, and the colours of whole
//! pictures.

use glint_core::colour::{Rgb565, Rounding, Shading};
use glint_core::light::{Light, MeshLighting};
use glint_core::mesh::{ChunkHeader, Mesh, MeshHeader, Triangle, Vertex};
use glint_core::picture::Size;
use glint_core::texture::{Blend, Filter, Format, Sampler, Source, Texture, Wrap, encode};
use glint_model::triangle::setup::Plane;
use glint_model::triangle::textured::{Textured, flat_light, lit, sample};
use glint_model::{Frame, MeshSubject, Subject};
use glint_vectors::meshes::{textured_layers, textured_square};
use glint_vectors::triangles::{SIZE, random_triangle, set_up};
use glint_vectors::{Camera, Picture, Random};

/// A texture in which the value of each texel is its position: the row in the high byte, the column in the low byte.
fn places(wrap: Wrap, filter: Filter) -> Source {
    Source {
        size_log2: [8, 8],
        sampler: Sampler {
            wrap: [wrap; 2],
            filter,
        },
        levels: vec![(0..=u16::MAX).collect()],
        ..Source::default()
    }
}

/// A texture with mip levels; the colour of a level is its number.
fn levels(size_log2: [u8; 2]) -> Vec<u8> {
    let [width, height] = size_log2;
    let level = |level: u8| {
        let [width, height] = [width, height].map(|side| 1 << side.saturating_sub(level));
        vec![u16::from(level); width * height]
    };
    encode(&Source {
        size_log2,
        levels: (0..=width.max(height)).map(level).collect(),
        ..Source::default()
    })
    .unwrap()
}

/// The linear function with these values at the corners of a triangle.
fn blend(weights: [f64; 3], values: [f64; 3]) -> f64 {
    weights.iter().zip(values).map(|(a, b)| a * b).sum()
}

/// Positions in random triangles are within a sixteenth of a texel of the exact positions, where the depth code is at least 2^12 and the
/// triangle has at most four repeats of 1024 texels. Mip levels change within an eighth of the exact limits.
#[test]
fn positions_and_levels_are_those_of_exact_perspective() {
    let mut random = Random(1);
    let bytes = levels([10, 10]);
    let texture = Texture::new_checked(&bytes).unwrap();
    let (mut worst, mut pixels) = (0.0_f64, 0);
    for _ in 0..4000 {
        let mut vertices = random_triangle(&mut random);
        let least = 1 << random.integer(12, 17);
        for vertex in &mut vertices {
            vertex.w =
                random.integer(least * 64, (least * 64 * 8).min(((1 << 18) - 4) * 64)) as u32;
        }
        let Some((triangle, setup)) = set_up(vertices, SIZE) else {
            continue;
        };
        let bounds = setup.bounds;
        let range = 1 << random.integer(8, 18);
        let place = random.integer(-(1 << 24), 1 << 24);
        let coordinates =
            [(); 3].map(|()| [(); 2].map(|()| (place + random.integer(0, range)) as i32));
        let textured = Textured::new(texture, &triangle, &setup, &coordinates, [0; 3], false);
        let corners = triangle.vertices.map(|v| [v.x, v.y].map(f64::from));
        let doubled = triangle.doubled_area as f64;
        let weights = triangle.vertices.map(|v| f64::from(v.w) / 64.0 + 0.5);
        for _ in 0..20 {
            let column = random.integer(bounds.left.into(), i64::from(bounds.right) - 1) as i32;
            let row = random.integer(bounds.top.into(), i64::from(bounds.bottom) - 1) as i32;
            let [right, down] = [column - setup.start_column, row - bounds.top].map(|x| x as u32);
            let at = |plane: Plane| {
                let in_row = plane.start.wrapping_add(plane.step_y.wrapping_mul(down));
                in_row.wrapping_add(plane.step_x.wrapping_mul(right))
            };
            let point = [column, row].map(|x| f64::from(256 * x + 128));
            let opposite = |i: usize| {
                let [a, b] = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
                ((b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0])) / doubled
            };
            let shares = [opposite(0), opposite(1), opposite(2)];
            if shares.iter().any(|&share| share < 0.0) {
                continue;
            }
            let exact_depth = blend(shares, weights);
            let depth = at(setup.depth).wrapping_add(1 << 13);
            let found = textured.places(depth, textured.axes.map(|axis| at(axis.plane)));
            // The largest change of a coordinate per pixel, and the steepest plane.
            let (mut most, mut steepest) = (0.0_f64, 0.0_f64);
            for axis in 0..2 {
                let values =
                    [0, 1, 2].map(|i| f64::from(coordinates[i][axis]) / 65_536.0 * weights[i]);
                let exact = blend(shares, values) / exact_depth;
                let period = 1024.0 * 2.0 * 256.0;
                let error = (found[axis] as f64 - exact * 1024.0 * 256.0 + 0.5).rem_euclid(period);
                worst = worst.max(error.min(period - error) / 256.0);
                for direction in 0..2 {
                    let step = |values: [f64; 3]| {
                        let moved = |i: usize| {
                            let [a, b] = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
                            256.0 * [a[1] - b[1], b[0] - a[0]][direction] / doubled
                        };
                        blend([moved(0), moved(1), moved(2)], values)
                    };
                    steepest = steepest.max(step(weights).abs()).max(step(values).abs());
                    let change = (step(values) - exact * step(weights)) / exact_depth;
                    most = most.max(1024.0 * change.abs());
                }
            }
            let level = textured.level(&setup, depth, textured.axes.map(|axis| at(axis.plane)));
            // Skips planes with larger steps, which do not fit an accumulator.
            if steepest > f64::from(1 << 17) {
                continue;
            }
            let apart = most / f64::from(1 << level);
            let fits = apart < 1.5 * 9.0 / 8.0 || level == 10;
            let is_finest = apart > 0.75 * 7.0 / 8.0 || level == 0;
            assert!(fits && is_finest, "level {level}: {apart}");
            pixels += 1;
        }
    }
    println!("{pixels} pixels, largest error {worst:.4} texels of 1024");
    assert!(pixels > 10_000);
    assert!(worst < 1.0 / 16.0, "{worst}");
}

/// A frame of a mesh in full light, without shading.
fn frame<'a>(mesh: Mesh<'a>, camera: &Camera, shading: Shading) -> Frame<'a> {
    let subject = Subject::Mesh(MeshSubject {
        shading,
        ..MeshSubject::new(mesh)
    });
    Frame {
        clear: Rgb565(0x001F),
        lighting: MeshLighting {
            ambient: [0xFF; 3],
            light: Light::at_camera([0; 3]),
        },
        ..Frame::new(subject, camera.rounded(), Size::W640)
    }
}

/// A floor under the camera, with and without clipped triangles, shows the texels that exact rays hit.
#[test]
fn a_floor_has_the_texels_that_rays_hit() {
    let texture = encode(&places(Wrap::Repeat, Filter::Nearest));
    let bytes = textured_square(&[texture.unwrap()], 0.5);
    let mesh = Mesh::new_checked(&bytes).unwrap();
    for (eye, shading) in [
        ([0.3, -0.4, 0.3], Shading::Flat),
        ([-1.0, -1.9, 0.1], Shading::Smooth),
    ] {
        let camera = Camera::looking(eye, [0.2, 1.0, 0.0], 0.8, 0.02);
        let frame = frame(mesh, &camera, shading);
        let picture = Picture::of_frame(&frame);
        let camera = Camera::of(&frame.view);
        let (mut hits, mut wrong, mut worst) = (0, 0, 0.0_f64);
        for (i, (&colour, &code)) in (0..).zip(picture.colour.iter().zip(&picture.depth)) {
            let pixel = [i % 640, i / 640].map(f64::from);
            let [width, height] = frame.size.pixels();
            let ray = camera.ray(pixel, glint_vectors::camera::Size { width, height });
            let t = -ray.origin[2] / ray.direction[2];
            let hit = ray.at(t);
            let is_hit = t > 0.05 && hit[0].abs() < 1.99 && hit[1].abs() < 1.99;
            if code == 0 || !is_hit {
                assert!(code != 0 || !is_hit, "pixel {pixel:?} is empty");
                continue;
            }
            let found = [colour & 0xFF, colour >> 8].map(f64::from);
            for axis in 0..2 {
                let exact = hit[axis] * 0.5 * 256.0;
                // The distance of the exact position from the texel found, which has the width 1.
                let off = (exact - found[axis]).rem_euclid(256.0);
                let off = if off > 128.0 {
                    256.0 - off
                } else {
                    (off - 1.0).max(0.0)
                };
                worst = worst.max(off);
                wrong += usize::from(off > 0.0);
            }
            hits += 1;
        }
        println!(
            "{hits} pixels, {wrong} coordinates in the neighbouring texel, largest error {worst:.4} texels"
        );
        assert!(hits > 50_000 && wrong < hits / 20, "{hits} {wrong}");
        // A pixel near the horizon is many texels wide, and the position of its centre has an error of up to 2^-7 pixel.
        assert!(worst < 0.7, "{worst}");
    }
}

/// Transparent texels do not change the colour and depth of the background.
#[test]
fn cut_out_texels_leave_colour_and_depth() {
    let chess = (0..64).map(|i| if (i + i / 8) % 2 == 0 { 0xF800 } else { 0x07E0 });
    let texture = encode(&Source {
        size_log2: [3, 3],
        key: Some(0xF800),
        levels: vec![chess.collect()],
        ..Source::default()
    });
    let bytes = textured_square(&[texture.unwrap()], 0.25);
    let camera = Camera::looking([0.0, -0.01, 2.5], [0.0; 3], 0.7, 0.1);
    let mesh = Mesh::new_checked(&bytes).unwrap();
    let picture = Picture::of_frame(&frame(mesh, &camera, Shading::Flat));
    let mut counts = [0_u32; 2];
    for (&colour, &code) in picture.colour.iter().zip(&picture.depth) {
        match colour {
            0x001F => assert_eq!(code, 0),
            0x07E0 => assert_ne!(code, 0),
            other => panic!("colour {other:04x}"),
        }
        counts[usize::from(code == 0)] += 1;
    }
    let [green, clear] = counts;
    assert!(green.abs_diff(clear) < 12_000, "{green} {clear}");
}

/// A texture of 8×8 texels of one colour.
fn plain(colour: u16, blend: Blend) -> Vec<u8> {
    let texture = encode(&Source {
        size_log2: [3, 3],
        blend,
        levels: vec![vec![colour; 64]],
        ..Source::default()
    });
    texture.unwrap()
}

/// Blending changes the colour of a pixel, but not its depth.
#[test]
fn blended_texels_keep_the_depth_behind_them() {
    const RED: u16 = 0xB800;
    const GREEN: u16 = 0x0620;
    let draw = |layers: &[(u16, Blend)]| {
        let textures: Vec<_> = layers
            .iter()
            .map(|&(colour, blend)| plain(colour, blend))
            .collect();
        let bytes = textured_layers(&textures, 1.0, 0.0);
        let camera = Camera::looking([0.0, -3.0, 2.5], [0.0; 3], 0.7, 0.1);
        let mesh = Mesh::new_checked(&bytes).unwrap();
        Picture::of_frame(&frame(mesh, &camera, Shading::Flat))
    };
    let [below, above] = [RED, GREEN].map(|colour| draw(&[(colour, Blend::Opaque)]));
    assert_eq!(below.depth, above.depth);
    for &blend in &Blend::ALL[1..] {
        let alone = draw(&[(GREEN, blend)]);
        assert!(alone.depth.iter().all(|&code| code == 0));
        let both = draw(&[(RED, Blend::Opaque), (GREEN, blend)]);
        assert_eq!(both.depth, below.depth);
        let mut blended = 0;
        for (i, &code) in below.depth.iter().enumerate() {
            let over = |behind| match code {
                0 => behind,
                _ => blend.over(Rgb565(above.colour[i]), Rgb565(behind)).0,
            };
            assert_eq!(alone.colour[i], over(0x001F), "{blend:?} {i}");
            assert_eq!(both.colour[i], over(below.colour[i]), "{blend:?} {i}");
            blended += u32::from(code != 0);
        }
        assert!(blended > 10_000, "{blended}");
        // A layer behind an opaque layer is not blended. At equal depths the later layer is drawn.
        let hidden = draw(&[(GREEN, blend), (RED, Blend::Opaque)]);
        assert_eq!(
            (hidden.colour, hidden.depth),
            (below.colour.clone(), below.depth.clone())
        );
    }
}

/// A replacement texture gives the picture of a mesh with this texture. A face without a texture keeps its colour.
#[test]
fn a_texture_replaces_those_of_the_mesh() {
    let other = plain(0x07E0, Blend::Opaque);
    let own = [plain(0xF800, Blend::Opaque), plain(0x001F, Blend::Additive)];
    // The first half of the first layer has no texture.
    let first = MeshHeader::BYTES + ChunkHeader::BYTES + 8 * Vertex::BYTES;
    let [own, same] = [&own[..], &[other.clone(), other.clone()]].map(|textures| {
        let mut bytes = textured_layers(textures, 0.3, 0.2);
        bytes[first + Triangle::TEXTURE.start] = 0;
        bytes
    });
    let [own, same] = [&own, &same].map(|bytes| Mesh::new_checked(bytes).unwrap());
    // Some triangles are clipped.
    let camera = Camera::looking([0.3, -1.9, 0.3], [0.2, 1.0, 0.0], 0.8, 0.02);
    for shading in [Shading::Flat, Shading::Smooth] {
        let replaced = Frame {
            replacement_texture: Some(Texture::new_checked(&other).unwrap()),
            ..frame(own, &camera, shading)
        };
        let [replaced, same, own] = [
            replaced,
            frame(same, &camera, shading),
            frame(own, &camera, shading),
        ]
        .map(|frame| Picture::of_frame(&frame));
        assert!(replaced.colour == same.colour && replaced.depth == same.depth);
        assert!(replaced.colour != own.colour);
    }
}

/// Full light does not change a colour, and no light gives black. Bilinear filtering of equal texels gives the colour of the texels.
#[test]
fn colours_at_the_limits_are_exact() {
    for colour in (0..=u16::MAX).map(Rgb565) {
        let texel = colour.fractions();
        for rounding in [Rounding::Dithered, Rounding::Nearest] {
            let under = |light| lit(texel, flat_light(Rgb565::WHITE, light), rounding);
            assert_eq!((under([256; 3]), under([0; 3])), (texel, [0; 3]));
            // A white texel is shown in the colour of the light in every pixel.
            let white = Rgb565::WHITE.fractions();
            let found = lit(white, flat_light(colour, [256; 3]), rounding);
            for place in (0..16).map(|place| [place % 4, place / 4]) {
                assert_eq!(Rgb565::rounded(found, rounding, place), colour);
            }
        }
    }
    let mut random = Random(7);
    for format in Format::ALL {
        let colour = Rgb565(random.bits() as u16);
        let (values, palette) = match format {
            Format::Rgb565 => (colour.0, vec![]),
            Format::Palette256 | Format::Palette16 => (1, vec![Rgb565(0), colour]),
        };
        let bytes = encode(&Source {
            format,
            size_log2: [4, 3],
            sampler: Sampler {
                filter: Filter::Bilinear,
                ..Sampler::default()
            },
            palette,
            levels: vec![vec![values; 128]],
            ..Source::default()
        });
        let bytes = bytes.unwrap();
        let texture = Texture::new_checked(&bytes).unwrap();
        let [r, g, b] = colour.channels();
        for _ in 0..1000 {
            let place = [(); 2].map(|()| random.bits() as i64 >> random.integer(0, 40));
            assert_eq!(sample(&texture, 0, place), Some([r << 3, g << 2, b << 3]));
        }
    }
}

/// Between the centres of two texels the colour changes linearly, also across the borders of the texture.
#[test]
fn bilinear_colours_are_between_their_texels() {
    for wrap in Wrap::ALL {
        let bytes = encode(&places(wrap, Filter::Bilinear)).unwrap();
        let texture = Texture::new_checked(&bytes).unwrap();
        // Blue is the column modulo 32.
        for place in 0..16 {
            let at = 256 * 5 + 128 + 16 * place;
            let [_, _, blue] = sample(&texture, 0, [at, 128]).unwrap();
            let expected = (16 * 5 * 8 + 8 * place + 8) / 16;
            assert_eq!(i64::from(blue), expected, "{wrap:?} {place}");
        }
        let [_, _, left] = sample(&texture, 0, [0, 128]).unwrap();
        let expected = match wrap {
            Wrap::Repeat => (31 * 8) / 2,
            Wrap::Mirror | Wrap::Clamp => 0,
        };
        assert_eq!(i64::from(left), expected, "{wrap:?}");
    }
}

/// No coordinate, accumulator or position causes a panic, for textures of any size and kind.
#[test]
fn anything_has_a_colour() {
    let mut random = Random(11);
    let any = |random: &mut Random| (random.bits() >> random.integer(32, 63)) as u32;
    for round in 0..2000 {
        let size_log2 = [(); 2].map(|()| random.integer(3, 6) as u8);
        let [width, height] = size_log2.map(|side| 1_usize << side);
        let bytes = encode(&Source {
            format: Format::ALL[round % 3],
            size_log2,
            sampler: Sampler {
                wrap: [Wrap::ALL[round / 3 % 3], Wrap::ALL[round / 9 % 3]],
                filter: Filter::ALL[round / 27 % 2],
            },
            levels: vec![vec![7; width * height]],
            ..Source::default()
        });
        let bytes = bytes.unwrap();
        let texture = Texture::new_checked(&bytes).unwrap();
        let Some((triangle, setup)) = set_up(random_triangle(&mut random), SIZE) else {
            continue;
        };
        let coordinates = [(); 3].map(|()| {
            [(); 2].map(|()| match random.integer(0, 3) {
                0 => i32::MIN,
                1 => i32::MAX,
                _ => random.bits() as i32,
            })
        });
        let (light, is_linear) = ([255; 3], random.coin());
        let textured = Textured::new(texture, &triangle, &setup, &coordinates, light, is_linear);
        for _ in 0..20 {
            let (depth, values) = (any(&mut random), [(); 2].map(|()| any(&mut random)));
            let level = textured.level(&setup, depth, values);
            assert_eq!(level, 0);
            let light = random.coin().then(|| [(); 3].map(|()| any(&mut random)));
            assert!(
                textured
                    .colour(depth, values, level, light, Rounding::Dithered)
                    .is_some()
            );
        }
    }
}
