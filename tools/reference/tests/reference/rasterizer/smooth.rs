//! Compares the model's smooth shading with exact perspective interpolation in f64.

use glint_reference::triangle::smooth::scenes;

#[test]
fn light_is_within_its_bound_of_the_exact_quotient() {
    let (mut clipped, mut back) = (0, 0);
    for scene in scenes() {
        let measured = scene.measure();
        println!(
            "{}: {} triangles, {} of them clipped, {} back faces, {} pixels, depth codes from {}\n\
             \x20   model {:.4} rms {:.4}, rounded {:.4} rms {:.4}, affine {:.2} rms {:.3}; bound {:.4}",
            scene.name,
            measured.triangles,
            measured.clipped,
            measured.back,
            measured.pixels,
            measured.farthest,
            measured.model.max,
            measured.model.rms(),
            measured.rounded.max,
            measured.rounded.rms(),
            measured.affine.max,
            measured.affine.rms(),
            scene.bound
        );
        assert!(measured.pixels > 1000, "{}", scene.name);
        assert!(
            measured.model.max <= scene.bound,
            "{}: {} steps off, allowed {}",
            scene.name,
            measured.model.max,
            scene.bound
        );
        clipped += measured.clipped;
        back += measured.back;
    }
    assert!(clipped > 20 && back > 20, "{clipped} clipped, {back} back");
}
