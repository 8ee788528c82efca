//! A hand in front of the virtual image sensor steers the camera of the scene: the whole way from the pins of the sensor's port over the
//! gesture engine, the firmware and the triangle engine to the monitor.

use crate::common::{console, mesh, running_board};
use glint::board::SimulatedBoard;
use glint::console::{Console, value};
use glint::gesture::{self, SensorFault, image_sensor};
use glint::picture::{Image, write_animation};
use glint::render::{Frame, Subject, on_model};
use glint::transfer;
use glint_core::console::Command;
use glint_core::mesh::Mesh;
use glint_core::picture::Size;
use std::sync::{Arc, Mutex};
use virtual_board::virtual_image_sensor::{Place, Scene};

/// Clock cycles of a millisecond.
const MS: u64 = 81_250;
/// Size of the sensor's frames.
const SIZE: [usize; 2] = [320, 240];
const COMMAND: &str = "gesture";

/// Where the hand was in each camera frame.
type Path = Arc<Mutex<Vec<Place>>>;

/// An image sensor that sees a hand on a path over the time in s, with the noise of a sensor and a face beside the hand.
fn sensor_with(hand: impl Fn(f64) -> Place + Send + 'static) -> (Scene, Path) {
    let path = Path::default();
    let seen = path.clone();
    let mut scene = Scene::new(SIZE, move |time| {
        let place = hand(time);
        seen.lock().unwrap().push(place);
        vec![place]
    });
    scene.noise = 2.0;
    (scene, path)
}

/// A hand in the middle of the frame, where the camera is at first. From `begin` on it goes along a figure eight, 0.3 s a round, and
/// becomes larger and smaller.
fn figure_eight(time: f64, begin: f64) -> Place {
    let turns = std::f64::consts::TAU * (time - begin).max(0.0) / 0.3;
    let width = 0.25 + 0.05 * turns.sin();
    Place {
        centre: [
            159.5 + 60.0 * turns.sin(),
            119.5 + 40.0 * (2.0 * turns).sin(),
        ],
        area: 320.0 * 240.0 * width * width,
    }
}

/// Azimuth and polar angle in degrees, and the distance, at which a hand puts the camera.
fn target(place: &Place) -> [f64; 3] {
    let [x, y] = place.centre;
    let width = (place.area / (320.0 * 240.0)).sqrt();
    [
        5.0 - 8.0 * (width - 0.0625),
        360.0 * ((x + 0.5) / 320.0 - 0.5),
        180.0 * (y + 0.5) / 240.0,
    ]
}

fn status(console: &mut Console<SimulatedBoard>) -> Vec<String> {
    console.command(COMMAND).unwrap()
}

fn entry<T: std::str::FromStr>(lines: &[String], key: &str) -> T {
    value(COMMAND, lines, key).unwrap()
}

fn numbers(lines: &[String], key: &str) -> Vec<f64> {
    let text: String = entry(lines, key);
    text.split(' ').map(|word| word.parse().unwrap()).collect()
}

fn run(console: &mut Console<SimulatedBoard>, milliseconds: u64) {
    console.board().inner().run(milliseconds * MS);
}

/// Largest error of the hand's centre in pixels, and of the camera's angles in degrees and its distance while the hand moves the
/// camera at up to four turns a second: the lag of the filters, after one camera frame.
const MOST: [f64; 3] = [0.3, 8.0, 0.2];
/// Largest mean number of cycles of the soft core for a camera frame. The aim is 4,000.
const CYCLES: u32 = 6_000;

/// The animation of the frames on the monitor.
const PICTURE: &str = "../../docs/pictures/holoforge.png";

/// The camera follows the path of the hand. With `GLINT_UPDATE` in the environment, the frames on the monitor become an animation
/// for the documentation.
#[test]
fn the_camera_follows_the_hand() {
    let mut board = running_board();
    let mut console = console(&mut board);
    let bytes = mesh("icosphere:3");
    transfer::stage(&mut console, &bytes).unwrap();
    transfer::upload(&mut console, &bytes, None, 1, &mut |_, _| {}).unwrap();
    let refused = console.command("scene holoforge").unwrap_err().to_string();
    assert!(refused.contains("no image sensor answers"), "{refused}");

    let begin = Arc::new(Mutex::new(f64::INFINITY));
    let known = begin.clone();
    let (scene, path) = sensor_with(move |time| figure_eight(time, *known.lock().unwrap()));
    console
        .board()
        .inner()
        .plug_image_sensor(image_sensor(scene));
    console.command("scene holoforge").unwrap();
    run(&mut console, 30);
    let now = console.board().inner().cycles();
    *begin.lock().unwrap() = now as f64 / (1_000.0 * MS as f64);
    let mut worst = [0.0_f64; 3];
    let films = std::env::var_os("GLINT_UPDATE").is_some();
    let mut film = Vec::new();
    // Half of the way; all of it for the animation.
    for _ in 0..if films { 19 } else { 10 } {
        if films {
            let shown = console.board().inner().capture().unwrap();
            film.push(Image {
                colour: shown.scaled_back(4).unwrap(),
                ..Image::empty(Size::W320)
            });
        } else {
            run(&mut console, 16);
        }
        let lines = status(&mut console);
        assert_eq!(entry::<String>(&lines, "hand"), "tracked", "{lines:#?}");
        assert_eq!(entry::<u32>(&lines, "frames_dropped"), 0);
        let (centre, camera) = (numbers(&lines, "centre"), numbers(&lines, "camera"));
        // The frame of these numbers is one of the last that the sensor began.
        let path = path.lock().unwrap();
        let distance = |place: &Place| {
            let [x, y] = place.centre;
            (centre[0] - x).hypot(centre[1] - y)
        };
        let last = path.iter().rev().take(8);
        let place = last.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let place = place.unwrap();
        let expected = target(place);
        let angle = (camera[1] - expected[1]).hypot(camera[2] - expected[2]);
        let errors = [distance(place), angle, (camera[0] - expected[0]).abs()];
        println!("{centre:.2?} {camera:.3?} {expected:.3?} {errors:.3?}");
        for (worst, error) in worst.iter_mut().zip(errors) {
            *worst = worst.max(error);
        }
    }
    if films {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(PICTURE);
        let file = std::fs::File::create(path).unwrap();
        write_animation(file, &film, 15).unwrap();
    }
    let lines = status(&mut console);
    println!("{lines:#?}");
    println!("worst errors: {worst:.3?}");
    for (worst, most) in worst.into_iter().zip(MOST) {
        assert!(worst < most, "{worst} of at most {most}");
    }
    assert!(entry::<u32>(&lines, "cycles_frame") <= CYCLES);

    // The camera stays when the image sensor is off. The picture is then that of the model.
    console.command("gesture off").unwrap();
    console.command("render").unwrap();
    let view: String = value("view", &console.command("view").unwrap(), "view").unwrap();
    let line = format!("view {view}");
    let Ok(Some(Command::View { view: Some(view) })) = Command::parse(&line) else {
        panic!("{line}");
    };
    let subject = Subject::mesh(Mesh::new_checked(&bytes).unwrap());
    let expected = on_model(&Frame::new(subject, view, Size::W320)).unwrap();
    let shown = console.board().inner().capture().unwrap();
    assert!(shown.scaled_back(4).unwrap() == expected.image.colour);
}

/// Rows of the table of faults in docs/hand.md: fault, text about the last camera frame, PCLK.
fn faults() -> Vec<(SensorFault, &'static str, &'static str)> {
    let rows = include_str!("../../../../docs/hand.md").lines();
    let rows = rows.filter_map(|row| {
        let [name, text, clock] = row.strip_prefix("| `")?.split(" | ").collect::<Vec<_>>()[..]
        else {
            return None;
        };
        let name = name.trim_end_matches('`');
        let mut all = SensorFault::ALL.into_iter();
        let fault = all.find(|fault| fault.name() == name)?;
        Some((fault, text, clock.trim_end_matches('|').trim()))
    });
    rows.collect()
}

/// With every fault the camera stays, and afterwards the hand is tracked again.
#[test]
fn every_fault_of_the_sensor_is_reported_and_holds_the_camera() {
    let mut board = running_board();
    let mut console = console(&mut board);
    let quiet = &mut |_: u64, _: u64| {};
    let faults = faults();
    assert_eq!(faults.len(), SensorFault::ALL.len());
    let (set_up, later): (Vec<_>, Vec<_>) =
        faults.into_iter().partition(|(.., clock)| clock.is_empty());
    for (fault, text, _) in set_up {
        let mut sensor = image_sensor(gesture::moving_hand(SIZE));
        fault.apply(&mut sensor, 0);
        console.board().inner().plug_image_sensor(sensor);
        let refused = console.command("gesture on").unwrap_err().to_string();
        let text = text.trim_start_matches("`gesture on` is refused: ");
        assert!(refused.contains(text), "{fault:?}: {refused}");
    }
    let refused = gesture::mask(&mut console, quiet).unwrap_err().to_string();
    assert!(refused.contains("0x2640"), "{refused}");

    // Where the camera is at first.
    let place = Place {
        centre: [159.5, 119.5],
        area: 4_800.0,
    };
    let (scene, _) = sensor_with(move |_| place);
    console
        .board()
        .inner()
        .plug_image_sensor(image_sensor(scene));
    let mask = gesture::mask(&mut console, quiet).unwrap();
    let marked: u32 = mask.bits.iter().map(|byte| byte.count_ones()).sum();
    // Every second pixel of every second line.
    assert_eq!([mask.width, mask.height], [160, 120]);
    assert!((1_120..1_280).contains(&marked), "{marked}");

    for (fault, text, clock) in later {
        run(&mut console, 16);
        let before = status(&mut console);
        assert_eq!(entry::<String>(&before, "hand"), "tracked", "{fault:?}");
        let mend = |console: &mut Console<SimulatedBoard>| {
            let board = console.board().inner();
            board.image_sensor().unwrap().fault = None;
        };
        let board = console.board().inner();
        fault.apply(board.image_sensor().unwrap(), SIZE[1] / 2);
        run(&mut console, 16);
        let lines = status(&mut console);
        println!("{fault:?}: {lines:#?}");
        assert_eq!(entry::<String>(&lines, "fault"), text, "{fault:?}");
        if clock != "stops and starts" {
            assert_eq!(entry::<String>(&lines, "pclk"), clock, "{fault:?}");
        }
        let [was, is] = [&before, &lines].map(|lines| numbers(lines, "camera"));
        // Before the fault began, the filter may have gone on.
        for (was, is) in was.into_iter().zip(is) {
            assert!((was - is).abs() < 0.2, "{fault:?}: {was}, {is}");
        }
        mend(&mut console);
    }
    run(&mut console, 16);
    let lines = status(&mut console);
    assert_eq!(entry::<String>(&lines, "hand"), "tracked");
    assert_eq!(entry::<String>(&lines, "fault"), "none");
}

/// A hand in the middle calibrates its colour, in full light and in half of it.
#[test]
fn a_calibration_finds_the_hand() {
    let mut board = running_board();
    let mut console = console(&mut board);
    let place = Place {
        centre: [160.0, 110.0],
        area: 18_000.0,
    };
    let (scene, _) = sensor_with(move |_| place);
    console
        .board()
        .inner()
        .plug_image_sensor(image_sensor(scene));
    let refused = console.command("gesture calibrate").unwrap_err();
    assert!(refused.to_string().contains("expected `gesture on` first"));
    console.command("gesture on").unwrap();
    let lines = console.command("gesture calibrate").unwrap();
    println!("{lines:#?}");
    let window = |key| numbers(&lines, key);
    let [cr, cb] = ["window_cr", "window_cb"].map(window);
    // The hand's colour has Cr 157 and Cb 103.
    assert!(cr[0] < 157.0 && 157.0 < cr[1] && cr[0] > 130.0, "{cr:?}");
    assert!(cb[0] < 103.0 && 103.0 < cb[1] && cb[1] < 126.0, "{cb:?}");
    run(&mut console, 20);
    assert_eq!(entry::<String>(&status(&mut console), "hand"), "tracked");
    // The mark of the hand's place is in the lower right corner.
    console.command("gesture mark").unwrap();
    run(&mut console, 40);
    let shown = console.board().inner().capture().unwrap();
    let frame = shown.scaled_back(4).unwrap();
    let marks = frame.iter().filter(|&&colour| colour == 0x07e0).count();
    assert!((16..40).contains(&marks), "{marks}");
}
