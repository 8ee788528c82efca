//! Tests of the colours of a field: fog, occlusion, grey.

use glint_core::camera::View;
use glint_core::field::Field;
use glint_core::fixed::{Q32_32, Turns, U4_28};
use glint_core::stereo::Stereo;
use glint_model::raymarch::{FieldOptions, FieldSetup, Palette};

fn setup(field: &str, half_width: &str, options: &FieldOptions) -> FieldSetup {
    let field = Field::parse(field).unwrap();
    let view = View::spherical(Q32_32::lit("3"), Turns(1 << 28), Turns(1 << 30)).unwrap();
    let view = View::new_checked(
        view.eye(),
        view.u(),
        view.v(),
        view.n(),
        half_width.parse().unwrap(),
        view.near(),
    );
    FieldSetup::new(&field, &view.unwrap(), (320, 180), options).unwrap()
}

#[test]
fn fog_falls_off_as_e_to_its_depth() {
    for (field, half_width) in [
        ("menger:3", "0.9"),
        ("cubes:16,1", "4"),
        ("cubes:0.25,0.1", "0.05"),
    ] {
        let setup = setup(field, half_width, &FieldOptions::default());
        for density in ["0.001", "0.05", "0.3", "1", "15.99"] {
            let density: U4_28 = density.parse().unwrap();
            let palette = Palette::default().with_fog(&setup, density);
            let units = setup.scale.to_num::<f64>() * f64::from(1 << setup.exponent);
            // The steps are a sixteenth of 2^fog_shift units long, and twice as long in each 32 entries after the first 64.
            let first = f64::from(1 << palette.fog_shift) / 16.0;
            let steps = (0..256).map(|i: i32| first * f64::from((i / 32 - 1).max(0)).exp2());
            let (mut most, mut start) = (0, 0.0);
            for ((i, step), &fog) in steps.enumerate().zip(&palette.fog) {
                let middle = start + step / 2.0;
                let hidden = 255.0 * (1.0 - (-density.to_num::<f64>() * middle / units).exp());
                assert!(
                    (f64::from(fog) - hidden).abs() < 0.51,
                    "{field} {density} {i}: {fog} {hidden}"
                );
                assert!(fog >= most, "fog decreases with depth");
                // The first and the last depth of the entry's range.
                let fine = 21_f64.exp2();
                for depth in [start * fine, (start + step) * fine - 1.0] {
                    assert_eq!(palette.fog_at(depth as u64), fog, "{field} {density} {i}");
                }
                (most, start) = (fog, start + step);
            }
            assert_eq!(start, f64::from(256 << palette.fog_shift));
            assert_eq!(palette.fog_at(1 << 40), most);
            assert!(most == 255 || palette.fog_shift == 7, "{field} {density}");
        }
    }
}

#[test]
fn a_frame_without_fog_has_the_palette_it_was_given() {
    // A field of rays by exits, and a field of marching rays.
    for (field, half, last) in [
        ("box:1,1,1", 7, 5),
        ("smooth:0.3,box:1,1,1+sphere:0.7", 40, 34),
    ] {
        let options = FieldOptions {
            palette: Palette::default().with_occlusion(&Field::parse(field).unwrap()),
            ..FieldOptions::default()
        };
        let setup = setup(field, "0.9", &options);
        assert_eq!(options.palette_for(&setup), options.palette);
        let occlusion = options.palette.occlusion;
        assert_eq!(
            (occlusion[0], occlusion[half], occlusion[255]),
            (255, 127, last)
        );
    }
}

#[test]
fn two_eyes_see_grey() {
    let options = FieldOptions {
        stereo: Some(Stereo::parse("0.05,3").unwrap()),
        fog: U4_28::ONE,
        ..FieldOptions::default()
    };
    let setup = setup("box:1,1,1", "0.9", &options);
    let palette = options.palette_for(&setup);
    assert!(palette.faces.iter().all(|[r, g, b]| r == g && g == b));
    assert_ne!(palette.fog, Palette::default().fog);
}
