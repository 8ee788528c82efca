//! Tests of fog on meshes, compared with computations in f64.

use glint_core::camera::Projection;
use glint_core::colour::Rgb565;
use glint_core::fixed::{Q32_32, U4_28};
use glint_core::mesh::Mesh;
use glint_core::picture::Size;
use glint_model::{DepthScale, Fog, Frame, MeshSetup, MeshSubject, Subject};
use glint_vectors::meshes::{self, at};
use glint_vectors::{Camera, Picture, Random};

/// The share that the fog hides, in 255ths, computed in f64.
fn exact(density: U4_28, depth: Q32_32) -> f64 {
    255.0 * (1.0 - (-density.to_num::<f64>() * depth.to_num::<f64>()).exp())
}

/// Scales of depth codes for cameras at several distances, in perspective and in orthographic projection.
fn scales() -> Vec<DepthScale> {
    let mut random = Random(11);
    let mut scales = vec![];
    for distance in [0.3, 2.0, 7.5] {
        let eye = random.direction().map(|part| distance * part);
        for near in [0.01, 0.5] {
            let camera = Camera::looking(eye, [0.0; 3], 0.9, near);
            for projection in [Projection::Perspective, Projection::Orthographic] {
                let view = camera.rounded().with_projection(projection);
                scales.push(MeshSetup::new(&view, 320, 180, 1 << 13).unwrap().depth);
            }
        }
    }
    scales
}

/// Each share is within 1.5/255 of the exact share at the depth of the code, and does not increase with the code. The densities range from
/// fog that hides everything to fog that hides nothing.
#[test]
fn shares_of_all_densities() {
    let densities = [1e-6, 0.001, 0.02, 0.1, 0.5, 3.0, 15.99].map(U4_28::from_num);
    for scale in scales() {
        let mut worst = (0.0, 0.0, 0);
        for density in densities {
            let fog = Fog::new(density, scale, [0; 3]).unwrap();
            let mut before = 255;
            for code in (1..256).chain((256..1 << 18).step_by(61)) {
                let share = fog.share(code);
                let depth = scale.distance(code).unwrap();
                let error = (f64::from(share) - exact(density, depth)).abs();
                if error > worst.0 {
                    worst = (error, density.to_num(), code);
                }
                assert!(share <= before, "code {code}, density {density}, {scale:?}");
                before = share;
            }
        }
        println!("{scale:?}: within {worst:?}");
        assert!(worst.0 < 1.5, "{scale:?}: {worst:?}");
    }
}

/// The offset of every density and scale fits the register of the engine, s13.
#[test]
fn offsets_fit_the_register() {
    let densities = [U4_28::from_bits(1), U4_28::MAX];
    let scales = [(1 << 16, -5), ((1 << 17) - 1, 5)].map(|(mantissa, exponent)| DepthScale {
        mantissa,
        exponent,
        origin: None,
    });
    for (density, scale) in densities.into_iter().zip(scales) {
        let offset = Fog::new(density, scale, [0; 3]).unwrap().offset;
        println!("density {density}, {scale:?}: offset {offset}");
        assert!((-4096..4096).contains(&offset));
    }
}

/// With the density 0 there is no fog. Fog with the share 0 does not change a colour, and fog that hides everything replaces the colour by
/// the fog's colour.
#[test]
fn ends_of_the_fog() {
    let [scale, ..] = scales()[..] else { panic!() };
    assert_eq!(Fog::new(U4_28::ZERO, scale, [0; 3]), None);
    let thin = Fog::new(U4_28::from_bits(1), scale, [255; 3]).unwrap();
    let dense = Fog::new(U4_28::MAX, scale, [255; 3]).unwrap();
    for colour in (0..=u16::MAX).step_by(37).map(Rgb565) {
        let colour = colour.fractions();
        assert_eq!(thin.over(thin.colour, colour, 1 << 17), colour);
        assert_eq!(
            dense.over(dense.colour, colour, 1),
            Rgb565::WHITE.fractions()
        );
    }
}

/// The mean colour of a floor in fog equals the mean of the exact mixtures, because dithering preserves the mean.
#[test]
fn a_floor_recedes_into_fog() {
    let [left, right] = [-1.9, 1.9];
    let corners = [
        at(left, left, 0.0),
        at(right, left, 0.0),
        at(0.0, right, 0.0),
    ];
    let bytes = meshes::mesh(&[(corners, 0x8410)], 65_535);
    let mesh = Mesh::new_checked(&bytes).unwrap();
    let camera = Camera::looking([0.0, -3.0, 1.0], [0.0; 3], 0.5, 0.1);
    let plain = Frame {
        clear: Rgb565::WHITE,
        ..Frame::new(
            Subject::Mesh(MeshSubject {
                cull: false,
                ..MeshSubject::new(mesh)
            }),
            camera.rounded(),
            Size::W320,
        )
    };
    let foggy = Frame {
        fog: U4_28::from_num(0.4),
        ..plain
    };
    let [plain_picture, foggy_picture] = [&plain, &foggy].map(Picture::of_frame);
    assert_eq!(plain_picture.depth, foggy_picture.depth);
    let constants = foggy.constants().unwrap();
    let scale = constants.depth_scale().unwrap();
    let (mut sums, mut count) = ([0.0; 2], 0);
    let pixels = plain_picture.colour.iter().zip(&foggy_picture.colour);
    for ((&from, &to), &code) in pixels.zip(&plain_picture.depth) {
        let Some(depth) = scale.distance(code) else {
            assert_eq!(from, to);
            continue;
        };
        let part = exact(foggy.fog, depth) / 255.0;
        let [from, to] = [from, to].map(|colour| f64::from(Rgb565(colour).to_rgb888()[0]));
        sums[0] += from + (255.0 - from) * part;
        sums[1] += to;
        count += 1;
    }
    let [exact, found] = sums.map(|sum| sum / f64::from(count));
    println!("{count} pixels: mean {found:.2}, exact {exact:.2}");
    assert!(count > 5_000 && (found - exact).abs() < 1.0);
}
