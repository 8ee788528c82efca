//! Tests of whole pictures in f64, and of the committed errors and cycles of the qualities.

use glint::scene::{self, Changes};
use glint_core::picture::Size;
use glint_core::quality::Quality;
use glint_model::Frame;
use glint_reference::picture::exact::Exact;
use glint_reference::picture::{Measured, SHOWN, measure};
use glint_reference::report::experiments::quality::{Row, errors};
use glint_reference::report::table::read_csv;
use glint_reference::report::workspace;
use glint_scene_file::{NAMES, SceneFile, built_in};
use serde::de::DeserializeOwned;

fn scenes() -> impl Iterator<Item = SceneFile> {
    let scenes = NAMES.into_iter().filter_map(built_in);
    scenes.filter(|scene| scene.scenes().is_empty())
}

/// Errors of the model's picture of a scene against the reference of the scene with a field of view of `fov` degrees.
fn against(scene: &SceneFile, fov: Option<&str>) -> Measured {
    let changes = Changes {
        quality: Some(Quality::Exact),
        ..Changes::default()
    };
    let draw = |frame: &Frame| {
        let view = match fov {
            Some(angle) => frame
                .view
                .with_field_of_view(glint_core::fixed::Turns::from_degrees(
                    angle.parse().expect("a number"),
                )),
            None => Ok(frame.view),
        };
        let view = view.expect("a field of view");
        let exact = Exact::new(&Frame { view, ..*frame }).expect("a frame of scenes");
        assert_eq!(exact.seen.len(), SHOWN.pixel_count());
        measure(frame, &exact).expect("a frame of scenes")
    };
    scene::draw(scene, &changes, draw).expect("a built-in scene")
}

/// With the same field of view, the model's picture differs from the reference only along edges and by the rounding of colours;
/// with another field of view, far more.
#[test]
fn the_models_picture_is_the_reference_but_for_rounding() {
    for scene in scenes() {
        let Measured { wrong, colour } = against(&scene, None);
        println!("{}: {wrong:.5}, {colour:.2}", scene.name());
        assert!(wrong < 0.01, "{}: {wrong}", scene.name());
        assert!(colour < 6.0, "{}: {colour}", scene.name());
        if scene.name() != "wireframe" {
            let other = against(&scene, Some("75"));
            assert!(
                other.wrong > 10.0 * wrong && other.colour > 2.0 * colour,
                "{}",
                scene.name()
            );
        }
    }
}

fn committed<T: DeserializeOwned>(name: &str) -> Vec<T> {
    read_csv(&workspace::path("docs/report").join(name)).expect("a committed table")
}

/// The committed errors of the small pictures equal the errors of the current code.
#[test]
fn committed_errors_are_todays() {
    let rows: Vec<Row> = committed("quality.csv");
    let now = errors("", &[Size::W320]).expect("built-in scenes");
    assert!(now.len() > scenes().count());
    for now in now {
        let same =
            |row: &&Row| (&row.scene, row.width, &row.rays) == (&now.scene, now.width, &now.rays);
        let row = rows.iter().find(same).expect("a committed row");
        for (committed, now) in [(row.wrong, now.wrong), (row.colour, now.colour)] {
            assert!((committed - now).abs() <= 1e-6 * now, "{row:?}: {now}");
        }
    }
}
