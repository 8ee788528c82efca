//! The model's raymarcher against the exact hits of the same rays. `--nocapture` shows the measured figures.

use glint_core::field::Field as Scene;
use glint_model::march::{FieldOptions, Setup};
use glint_reference::camera::{Camera, Size};
use glint_reference::field::metrics::{accuracy, expected};
use glint_reference::field::{Field, marched, views};

const SIZE: Size = Size {
    width: 320,
    height: 180,
};

/// Farther than anything in a picture, in world units.
const FAR: f64 = 100.0;

#[test]
fn the_sponge_is_where_it_is() {
    let sponge = Field::Menger { depth: 4 };
    for (name, eye, target) in views::views() {
        let view = views::camera(eye, target).view().expect("a camera");
        let camera = Camera::from(&view);
        let expected = expected(&sponge, SIZE, (camera.near, FAR), |pixel| {
            camera.ray(pixel, SIZE)
        });
        let options = FieldOptions::default();
        let size = (SIZE.width, SIZE.height);
        let setup = Setup::new(&Scene::Menger { depth: 4 }, &view, size, &options).expect("a size");
        let picture = marched::picture(&setup, 0, marched::units_per_world(&sponge));
        let by_t: Vec<_> = picture.iter().map(|ray| ray.outcome).collect();
        let found = accuracy(&expected, &by_t);
        let steps: u64 = picture.iter().map(|ray| u64::from(ray.steps)).sum();
        println!(
            "{name}: {found:?}, {:.2} evaluations a ray",
            steps as f64 / found.rays as f64
        );
        let depth = found.depth.expect("it shows the sponge");
        assert!(found.iou >= 0.999 && found.wrong_faces <= 0.01, "{name}");
        assert!(depth.median <= 2e-4, "{name}");
        // What grazes a face for long: it is behind its edge or ends before it.
        assert!(
            depth.p99 <= if name == "grazing" { 8e-3 } else { 3e-3 },
            "{name}"
        );
        assert!(found.undecided <= 2, "{name}");
        assert!(steps as f64 <= 14.4 * found.rays as f64, "{name}");
    }
}
