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
        assert!(found.iou > 0.997 && found.undecided == 0, "{name}");
    }
}
