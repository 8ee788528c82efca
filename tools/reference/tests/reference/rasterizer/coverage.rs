//! Checks the model's pixels of single triangles. Coverage and depth are compared with the exact rasterizer, with the model's
//! snapped vertices. Coverage is also compared with the unsnapped triangle: pixels inside by more than a tolerance must be drawn,
//! pixels outside by more than a tolerance must not (see `surface::Class`).

use glint_model::DrawnTriangle;
use glint_reference::camera::{Camera, Size};
use glint_reference::triangle::exact::{ExactTriangle, SnappedVertex};
use glint_reference::triangle::surface::{Class, ProjectedTriangle};
use glint_vectors::Picture;

use super::scenes::{Case, LARGE, Scene, random_case};

/// Counts and largest errors of a comparison.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    triangles: u64,
    clipped: u64,
    covered: u64,
    missing: u64,
    extra: u64,
    depth_error: f64,
    class_missing: u64,
    class_extra: u64,
    partial: u64,
    partial_drawn: u64,
}

impl Tally {
    fn add(&mut self, other: Self) {
        self.triangles += other.triangles;
        self.clipped += other.clipped;
        self.covered += other.covered;
        self.missing += other.missing;
        self.extra += other.extra;
        self.depth_error = self.depth_error.max(other.depth_error);
        self.class_missing += other.class_missing;
        self.class_extra += other.class_extra;
        self.partial += other.partial;
        self.partial_drawn += other.partial_drawn;
    }
}

/// Largest allowed deviation of a depth from the plane through the snapped vertices, in depth codes.
pub const DEPTH_LIMIT: f64 = 2.0;

/// Largest allowed displacement of an edge by snapping, in pixels. The Khronos conformance tests allow three steps of the
/// subpixel grid, which are 3/256 pixel.
pub fn snap_limit(size: Size) -> f64 {
    if size == LARGE {
        2.0 / 256.0
    } else {
        1.0 / 256.0
    }
}

/// Converts a drawn triangle to a triangle of the exact rasterizer, or returns `None` if its area is 0.
fn exact(drawn: &DrawnTriangle) -> Option<ExactTriangle> {
    ExactTriangle::new(drawn.vertices.map(|vertex| SnappedVertex {
        x: vertex.x.into(),
        y: vertex.y.into(),
        w: vertex.w.into(),
    }))
}

/// Draws each triangle of a case alone and compares all pixels with the exact rasterizer and with the unsnapped triangle.
pub fn check(case: &Case) -> Tally {
    let view = case.camera.rounded();
    let camera = Camera::of(&view);
    let mut total = Tally::default();
    for triangle in 0..case.scene.triangles.len() {
        let scene = case.scene.only(triangle);
        let picture = scene.draw(&view, case.size, case.cull);
        let mut tally = against_exact(&picture, case.size);
        classify(&picture, &camera, &scene, case, &mut tally);
        tally.triangles = 1;
        tally.clipped = picture.stats.clipped.into();
        let good = tally.missing + tally.extra + tally.class_missing + tally.class_extra == 0
            && tally.depth_error <= DEPTH_LIMIT;
        assert!(
            good,
            "{}, triangle {triangle}: {tally:?}\n{:?} at {:?}\n{camera:?}\n{:?}",
            case.name,
            case.scene.corners(triangle),
            case.size,
            picture.drawn,
        );
        total.add(tally);
    }
    total
}

/// Compares a picture that shows one triangle with the exact coverage and depth of the parts into which the
/// model clipped the triangle.
fn against_exact(picture: &Picture, size: Size) -> Tally {
    let mut tally = Tally::default();
    let mut left = picture.depth.clone();
    for part in picture.drawn.iter().filter_map(exact) {
        part.for_each_pixel(size.width, size.height, |column, row| {
            let code = &mut left[(row * size.width + column) as usize];
            if *code == 0 {
                // The pixel was not drawn, or was already counted for another part. The second case is also an error, because
                // parts do not overlap.
                tally.missing += 1;
            } else {
                tally.covered += 1;
                let error = part.depth(column.into(), row.into()).error_of(*code).abs();
                tally.depth_error = tally.depth_error.max(error);
                *code = 0;
            }
        });
    }
    tally.extra = left.iter().filter(|&&code| code != 0).count() as u64;
    tally
}

/// Compares a picture that shows one triangle with the class of each pixel for the unsnapped triangle.
fn classify(picture: &Picture, camera: &Camera, scene: &Scene, case: &Case, tally: &mut Tally) {
    let size = case.size;
    let triangle = ProjectedTriangle::new(camera, size, scene.corners(0));
    let hidden = case.cull && !triangle.front;
    let mut drawn = picture.covered() as u64;
    let [columns, rows] = triangle.bounds(size);
    for row in rows {
        for column in columns.clone() {
            let is_drawn = picture.depth[(row * size.width + column) as usize] != 0;
            drawn -= u64::from(is_drawn);
            match triangle.classify(column, row, snap_limit(size)) {
                Class::Full if hidden => tally.class_extra += u64::from(is_drawn),
                Class::Full => tally.class_missing += u64::from(!is_drawn),
                Class::Partial => {
                    tally.partial += 1;
                    tally.partial_drawn += u64::from(is_drawn);
                }
                Class::None => tally.class_extra += u64::from(is_drawn),
            }
        }
    }
    // The remaining drawn pixels are outside the triangle's bounds, where no pixel may be drawn.
    tally.class_extra += drawn;
}

#[test]
fn random_scenes_are_covered_exactly() {
    let mut total = Tally::default();
    for seed in 0..240 {
        total.add(check(&random_case(seed)));
    }
    println!("240 random scenes: {total:?}");
    assert!(
        total.covered > 1_000_000,
        "too few pixels were compared: {total:?}"
    );
    assert!(
        total.clipped > 100,
        "too few triangles were clipped: {total:?}"
    );
}
