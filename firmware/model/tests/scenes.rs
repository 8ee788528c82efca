//! The built-in scenes have valid places, cameras and lights.

use glint_core::fixed::Q32_32;
use glint_model::scenes::{Settings, objects};

#[test]
fn scenes_are_valid() {
    assert_eq!(objects().count(), 5);
    let settings = Settings::objects().unwrap();
    let simplegpu = Settings::simplegpu().unwrap();
    for settings in [settings, simplegpu] {
        assert!(!settings.lighting.light.is_at_camera());
    }
    // 150 degrees across: the tangent of 75 degrees.
    let half_width: f64 = simplegpu.view.half_width().to_num();
    assert!((half_width - 75_f64.to_radians().tan()).abs() < 1e-5);
    let eye = settings.view.eye().map(Q32_32::to_num::<f64>);
    assert!((eye.map(|x| x * x).iter().sum::<f64>().sqrt() - 2.2).abs() < 1e-6);
}
