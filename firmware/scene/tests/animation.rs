//! Tests of animations: the scene after a time, moved directly and by the animator of a board.

use glint_core::fixed::U32_32;
use glint_scene::{Animator, AnyBoard, Defaults, Scene};

/// Ten hours, in seconds.
const TEN_HOURS: u32 = 36_000;

fn scene(lines: &str) -> Scene {
    let mut scene = Scene::new(Defaults::GATEWARE).expect("a camera in range");
    execute(&mut scene, lines);
    scene
}

fn execute(scene: &mut Scene, lines: &str) {
    for line in glint_scene::lines(lines) {
        let (_, line) = line.expect("a line of a scene");
        line.apply(scene, &mut AnyBoard).expect("in range");
    }
}

fn seconds(number: u32) -> U32_32 {
    U32_32::from_num(number)
}

/// The time of a frame in seconds: a second is not a whole number of frames.
fn frame(number: u64) -> U32_32 {
    U32_32::from_bits(((u128::from(number * 13_543_217) << 32) / 81_250_000) as u64)
}

/// A scene without its animation.
fn still(mut scene: Scene) -> Scene {
    execute(&mut scene, "animate off");
    scene
}

/// After ten hours, in many frames or in one step, the scene equals the scene in which the final angle was set.
#[test]
fn a_scene_is_exact_after_ten_hours() {
    let cases = [
        // Ten hours and a second at 45 degrees a second are 45 degrees beyond whole turns.
        ("camera 3 10 60\nanimate azimuth 45", "camera 3 55 60"),
        (
            "field moving:0.3,1,350\nanimate orbit -45",
            "field moving:0.3,1,305",
        ),
        (
            "field union:box:1,1,0.1+moving:0.3,1\nanimate orbit 359",
            "field union:box:1,1,0.1+moving:0.3,1,359",
        ),
        (
            "object add a scale 0.5,0.7,1.3 rotate x 20 move 1,0,0\nanimate turn y 45",
            "object remove all\nobject add a scale 0.5,0.7,1.3 rotate x 20 rotate y 45 move 1,0,0",
        ),
        (
            "object add a\nobject add b move 1,1,1\nanimate turn 2 z 30 azimuth 90",
            "object remove 2\nobject add b rotate z 30 move 1,1,1\ncamera 2.5 130 65",
        ),
    ];
    for (lines, change) in cases {
        let start = scene(lines);
        let mut expected = still(start.clone());
        execute(&mut expected, change);
        let end = seconds(TEN_HOURS + 1);
        let mut at_once = start.clone();
        at_once.animate(U32_32::ZERO, end, true);
        assert_eq!(still(at_once), expected, "{lines}");

        let (mut animator, mut by_frames) = (Animator::default(), start);
        // The board has been on for hours.
        let on = seconds(TEN_HOURS);
        let frames = (0..).map(frame).take_while(|time| *time < end);
        for time in frames {
            animator.advance(&mut by_frames, || on + time, true);
        }
        animator.advance(&mut by_frames, || on + end, true);
        assert_eq!(still(by_frames), expected, "{lines}");
    }
}

/// The time of a board wraps after 2^32 s, 136 years.
#[test]
fn the_wrap_of_the_time_does_no_harm() {
    let (mut animator, mut scene) = (
        Animator::default(),
        scene("camera 3 0 60\nanimate azimuth 10"),
    );
    let on = U32_32::MAX - seconds(2);
    for step in 0..=8 {
        animator.advance(&mut scene, || on.wrapping_add(seconds(step)), true);
    }
    execute(&mut scene, "animate off");
    let mut expected = scene.clone();
    execute(&mut expected, "camera 3 80 60");
    assert_eq!(scene, expected);
}

#[test]
fn an_animation_starts_when_it_is_set() {
    let mut animator = Animator::default();
    let mut scene = scene("camera 3 0 60");
    let mut expect = |scene: &mut Scene, time, moves_camera, expected: f64| {
        animator.advance(scene, || seconds(time), moves_camera);
        let found = scene.sphere.theta.to_degrees().to_num::<f64>();
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    };
    expect(&mut scene, 5, true, 0.0);
    execute(&mut scene, "animate azimuth 10");
    expect(&mut scene, 6, true, 0.0);
    expect(&mut scene, 7, true, 10.0);
    // A new azimuth is the start of further motion.
    execute(&mut scene, "camera 3 90 60");
    expect(&mut scene, 8, true, 100.0);
    // While the sensor steers the camera, the azimuth is constant.
    expect(&mut scene, 10, false, 100.0);
    expect(&mut scene, 11, true, 110.0);
    execute(&mut scene, "animate off");
    expect(&mut scene, 20, true, 110.0);
    execute(&mut scene, "animate azimuth 10");
    expect(&mut scene, 30, true, 110.0);
    expect(&mut scene, 31, true, 120.0);
}

/// Commands act on the shown placement and angle, and the motion continues from there.
#[test]
fn commands_act_on_what_is_shown() {
    let mut moved = scene("object add a move 1,0,0\nanimate turn z 30");
    moved.animate(seconds(0), seconds(3), true);
    execute(&mut moved, "object rotate 1 x 40");
    moved.animate(seconds(3), seconds(4), true);
    let expected = scene("object add a rotate z 90 move 1,0,0 rotate x 40");
    let turned = expected.objects[0].place.matrix.turned(
        glint_core::matrix::Axis::Z,
        glint_core::fixed::Turns::from_degrees(30.into()),
    );
    assert_eq!(Ok(moved.objects[0].place.matrix), turned);

    let mut moved = scene("field moving:0.3,1\nanimate orbit 90");
    moved.animate(seconds(0), seconds(1), true);
    execute(&mut moved, "field moving:0.2,1,10");
    moved.animate(seconds(1), seconds(2), true);
    assert_eq!(still(moved), scene("field moving:0.2,1,100"));
}

/// Parts that the scene does not show do not move, so that the picture stays and the board sleeps.
#[test]
fn what_is_not_shown_rests() {
    for lines in [
        "animate off",
        "field sphere:1\nanimate orbit 30",
        "field moving:0.3,1\nobject add a\nanimate orbit 30",
        "object add a\nscene b\nanimate turn z 30",
        "object add a\nanimate turn 2 z 30",
        "program\nanimate azimuth 30 orbit 30",
    ] {
        let start = scene(lines);
        let mut moved = start.clone();
        moved.animate(seconds(0), seconds(5), true);
        assert_eq!(moved, start, "{lines}");
    }
}

/// An object keeps its last placement at the angles at which its matrix would be out of range.
#[test]
fn an_object_out_of_range_rests() {
    let mut scene = scene("object add a matrix 16,16,0,-16,16,0,0,0,1\nanimate turn z 15");
    let before = scene.clone();
    scene.animate(seconds(0), seconds(3), true);
    assert_eq!(scene, before);
    scene.animate(seconds(3), seconds(6), true);
    assert_ne!(scene, before, "a quarter turn");
}
