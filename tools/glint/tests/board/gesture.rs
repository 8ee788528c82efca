//! A hand in front of the virtual image sensor steers the camera of the scene. The tests cover the
//! whole path from the pins of the sensor's port through the gesture engine, the firmware and the
//! triangle engine to the monitor.

use crate::common::{console, emulator, mesh, small};
use glint::board::Uart;
use glint::board::{EmulatedBoard, SimulatedBoard, Simulation};
use glint::console::{Console, value};
use glint::gesture::{self, SensorFault, image_sensor};
use glint::imu::sensor;
use glint::picture::{Image, write_animation};
use glint::render::{Frame, Subject, on_model};
use glint::transfer;
use glint_core::console::{Command, Setting};
use glint_core::mesh::Mesh;
use glint_core::picture::Size;
use std::sync::{Arc, Mutex};
use virtual_board::virtual_image_sensor::{Hand, ImageSensor, Model, Scene, Timing};

/// Number of clock cycles in a millisecond.
const MS: u64 = 81_250;
/// Size of the sensor's frames in pixels.
const SIZE: [usize; 2] = [320, 240];
const COMMAND: &str = "gesture";

/// The hand's position in each camera frame.
type Path = Arc<Mutex<Vec<Hand>>>;

/// The scene in front of an image sensor, which a test sets: hands, and the brightness of the
/// light.
#[derive(Clone)]
struct View(Arc<Mutex<(Vec<Hand>, f64)>>);

impl View {
    /// One hand in full light.
    fn new(hand: Hand) -> Self {
        Self(Arc::new(Mutex::new((vec![hand], 1.0))))
    }

    fn show(&self, hands: &[Hand], light: f64) {
        *self.0.lock().unwrap() = (hands.to_vec(), light);
    }

    /// A source of frames with sensor noise.
    fn scene(&self) -> Scene {
        let [hands, light] = [self.clone(), self.clone()];
        let mut scene = Scene::new(SIZE, move |_| hands.0.lock().unwrap().0.clone());
        scene.light = Box::new(move |_| light.0.lock().unwrap().1);
        scene.noise = 2.0;
        scene
    }
}

/// A scene with sensor noise and a hand whose position depends on the time in s. The path records
/// the hand of each frame.
fn sensor_with(hand: impl Fn(f64) -> Hand + Send + 'static) -> (Scene, Path) {
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

/// A hand in the middle of the frame, which corresponds to the initial camera. From the time
/// `begin` on the hand moves along a figure eight with a period of 0.3 s, and its size changes.
fn figure_eight(time: f64, begin: f64) -> Hand {
    let turns = std::f64::consts::TAU * (time - begin).max(0.0) / 0.3;
    let width = 0.25 + 0.05 * turns.sin();
    Hand {
        centre: [
            159.5 + 60.0 * turns.sin(),
            119.5 + 40.0 * (2.0 * turns).sin(),
        ],
        area: 320.0 * 240.0 * width * width,
    }
}

/// The camera's distance, and its azimuth and polar angle in degrees, for a hand.
fn target(place: &Hand) -> [f64; 3] {
    let [x, y] = place.centre;
    let width = (place.area / (320.0 * 240.0)).sqrt();
    [
        5.0 - 8.0 * (width - 0.0625),
        360.0 * ((x + 0.5) / 320.0 - 0.5),
        180.0 * (y + 0.5) / 240.0,
    ]
}

fn status(console: &mut Console<SimulatedBoard<EmulatedBoard>>) -> Vec<String> {
    console.command(COMMAND).unwrap()
}

fn entry<T: std::str::FromStr>(lines: &[String], key: &str) -> T {
    value(COMMAND, lines, key).unwrap()
}

fn numbers(lines: &[String], key: &str) -> Vec<f64> {
    let text: String = entry(lines, key);
    text.split(' ').map(|word| word.parse().unwrap()).collect()
}

fn run(console: &mut Console<SimulatedBoard<EmulatedBoard>>, milliseconds: u64) {
    console.board().inner().run(milliseconds * MS);
}

/// Maximum errors of the hand's centre in pixels, of the camera's angles in degrees, and of its
/// distance, while the hand moves the camera at up to four turns per second. They result from the
/// lag of the filters after one camera frame. Where the hand turns fast, the region of interest cuts off
/// an edge of the hand in a frame; in the other frames its centre is within 0.3 pixels.
const MAX_ERRORS: [f64; 3] = [0.6, 8.0, 0.2];
/// Maximum error of the hand's centre in pixels in the first 16 ms. The hand starts at full speed,
/// so in one frame the region of interest, which fits a hand at rest, cuts off a part of the hand.
const START: f64 = 3.0;
/// Milliseconds between two looks at the state: less than a camera frame, so each frame is checked.
const LOOK: u64 = 2;
/// Maximum of the soft core's mean number of cycles for a camera frame.
const CYCLES: u32 = 4_000;

/// The animation of the frames on the monitor.
const PICTURE: &str = "../../docs/pictures/holoforge.png";

/// The camera follows the path of the hand. If the environment variable `GLINT_UPDATE` is set, the frames on the monitor are
/// written as an animation for the documentation.
#[test]
fn the_camera_follows_the_hand() {
    let mut board = emulator();
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
    // The uploaded mesh replaces the mesh of the scene.
    console.command("scene model").unwrap();
    run(&mut console, 30);
    let now = console.board().inner().cycles();
    *begin.lock().unwrap() = now as f64 / (1_000.0 * MS as f64);
    let mut worst = [0.0_f64; 3];
    let films = std::env::var_os("GLINT_UPDATE").is_some();
    let mut film = Vec::new();
    // The hand moves along half of the path; if an animation is recorded, along the whole path.
    for step in 0..if films { 19 } else { 160 / LOOK } {
        if films {
            film.push(Image {
                colour: console.board().inner().monitor_frame(4).unwrap(),
                ..Image::empty(Size::W320)
            });
        } else {
            run(&mut console, LOOK);
        }
        let lines = status(&mut console);
        assert_eq!(entry::<String>(&lines, "hand"), "tracked", "{lines:#?}");
        assert_eq!(entry::<u32>(&lines, "frames_dropped"), 0);
        let (centre, camera) = (numbers(&lines, "centre"), numbers(&lines, "camera"));
        // The values belong to one of the last frames that the sensor began.
        let path = path.lock().unwrap();
        let distance = |place: &Hand| {
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
        if step * LOOK < 16 {
            assert!(errors[0] < START, "{errors:.3?}");
            continue;
        }
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
    for (worst, most) in worst.into_iter().zip(MAX_ERRORS) {
        assert!(worst < most, "{worst} of at most {most}");
    }
    assert!(entry::<u32>(&lines, "cycles_frame") <= CYCLES);

    // The camera does not move when the image sensor is off. The picture then equals the model's.
    console.command("gesture off").unwrap();
    console.command("render").unwrap();
    let view: String = value("view", &console.command("view").unwrap(), "view").unwrap();
    let line = format!("view {view}");
    let Ok(Some(Command::Set(Setting::View { view }))) = Command::parse(&line) else {
        panic!("{line}");
    };
    let subject = Subject::mesh(Mesh::new_checked(&bytes).unwrap());
    let expected = on_model(&Frame::new(subject, view, Size::W320)).unwrap();
    let shown = console.board().inner().monitor_frame(4).unwrap();
    assert!(shown == expected.image.colour);
}

/// Rows of the table of faults in docs/gesture-control.md: fault, text about the last camera frame, PCLK.
fn faults() -> Vec<(SensorFault, &'static str, &'static str)> {
    let rows = include_str!("../../../../docs/gesture-control.md").lines();
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

/// Hand position of the initial camera.
const MIDDLE: Hand = Hand {
    centre: [159.5, 119.5],
    area: 4_800.0,
};

/// Time in ms until an unplugged sensor is set up again and the hand is found: the time to the next check of the sensor, its
/// set-up, and three frames.
const RETURN: u64 = 125;

/// The camera does not move during a fault, and the hand is tracked again after it. Then each case
/// of the table "the image sensor sees" has the outcome of the table.
#[test]
fn every_fault_of_the_sensor_is_reported_and_holds_the_camera() {
    let mut board = emulator();
    board.inner().plug(sensor::virtual_sensor(None));
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

    let view = View::new(MIDDLE);
    let board = console.board().inner();
    board.plug_image_sensor(image_sensor(view.scene()));
    let mask = gesture::mask(&mut console, quiet).unwrap();
    let marked: u32 = mask.bits.iter().map(|byte| byte.count_ones()).sum();
    // The mask contains every second pixel of every second line.
    assert_eq!([mask.width, mask.height], [160, 120]);
    assert!((1_120..1_280).contains(&marked), "{marked}");

    sensor::wait(&mut console).unwrap();
    let samples = |console: &mut Console<SimulatedBoard<EmulatedBoard>>| {
        let lines = console.command("imu").unwrap();
        ["samples", "failures", "gaps"].map(|key| value::<u64>("imu", &lines, key).unwrap())
    };
    let [first, ..] = samples(&mut console);
    let began = console.board().inner().cycles();
    for (fault, text, clock) in later {
        run(&mut console, 16);
        let before = status(&mut console);
        assert_eq!(entry::<String>(&before, "hand"), "tracked", "{fault:?}");
        let board = console.board().inner();
        fault.apply(board.image_sensor().unwrap(), SIZE[1] / 2);
        run(&mut console, 16);
        let lines = status(&mut console);
        println!("{fault:?}: {lines:#?}");
        assert_eq!(entry::<String>(&lines, "fault"), text, "{fault:?}");
        if clock != "stops and starts" {
            assert_eq!(entry::<String>(&lines, "pclk"), clock, "{fault:?}");
        }
        stays(&before, &lines, &format!("{fault:?}"));
        let board = console.board().inner();
        board.image_sensor().unwrap().fault = None;
        if fault == SensorFault::Unplugged {
            run(&mut console, RETURN);
        }
    }
    run(&mut console, 16);
    let lines = status(&mut console);
    assert_eq!(entry::<String>(&lines, "hand"), "tracked");
    assert_eq!(entry::<String>(&lines, "fault"), "none");
    // The gyroscope was read once a millisecond throughout.
    let [last, failures, gaps] = samples(&mut console);
    let passed = (console.board().inner().cycles() - began) / MS;
    assert!(
        (last - first).abs_diff(passed) < 5,
        "{first} {last} {passed}"
    );
    assert_eq!([failures, gaps], [0; 2]);

    sights_have_their_outcomes(&mut console, &view);
}

/// Checks that the camera does not move, except for the filter's response to the previous frames.
fn stays(before: &[String], after: &[String], case: &str) {
    for (was, is) in core::iter::zip(numbers(before, "camera"), numbers(after, "camera")) {
        assert!((was - is).abs() < 0.2, "{case}: {was}, {is}");
    }
}

/// The views of the image sensor for the table in docs/gesture-control.md, in the order of its rows: name, hands, light, and time in ms.
fn sights() -> [(&'static str, Vec<Hand>, f64, u64); 5] {
    let far = Hand {
        centre: [285.0, 150.0],
        area: 2_400.0,
    };
    let right = Hand {
        centre: [183.5, 119.5],
        ..MIDDLE
    };
    [
        ("a second hand, 125 pixels away", vec![MIDDLE, far], 1.0, 16),
        ("one hand, in half of the light", vec![MIDDLE], 0.5, 16),
        ("the full light again", vec![MIDDLE], 1.0, 16),
        ("no hand", vec![], 1.0, 16),
        ("the hand, 24 pixels to the right", vec![right], 1.0, 50),
    ]
}

/// Runs the cases of the table "the image sensor sees".
fn sights_have_their_outcomes(console: &mut Console<SimulatedBoard<EmulatedBoard>>, view: &View) {
    let rows = include_str!("../../../../docs/gesture-control.md").lines();
    let mut rows = rows.skip_while(|row| !row.starts_with("| the image sensor sees |"));
    for ((name, hands, light, time), row) in core::iter::zip(sights(), rows.by_ref().skip(2)) {
        let [_, sight, presence, camera, _] = row.split('|').map(str::trim).collect::<Vec<_>>()[..]
        else {
            panic!("expected a row of three cells, found {row}");
        };
        assert_eq!(sight, name);
        let before = status(console);
        view.show(&hands, light);
        run(console, time);
        let after = status(console);
        println!("{name}: {after:#?}");
        assert_eq!(entry::<String>(&after, "hand"), presence, "{name}");
        if camera == "stays" {
            stays(&before, &after, name);
            continue;
        }
        // The camera is between its previous and its final position.
        let [was, is] = [&before, &after].map(|lines| numbers(lines, "camera")[1]);
        let hand = target(&hands[0])[1];
        let part = (is - was) / (hand - was);
        assert!((0.01..1.0).contains(&part), "{name}: {was}, {is}, {hand}");
    }
    assert!(!rows.next().is_some_and(|row| row.starts_with('|')));
}

/// A calibration finds the colour of a hand in front of an OV5640.
#[test]
fn a_calibration_finds_the_hand() {
    let mut board = emulator();
    let mut console = small(&mut board);
    let place = Hand {
        centre: [160.0, 110.0],
        area: 18_000.0,
    };
    let scene = View::new(place).scene();
    let sensor = ImageSensor::new(Model::Ov5640, scene, Timing::SHORT);
    console.board().inner().plug_image_sensor(sensor);
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
    let lines = status(&mut console);
    assert_eq!(entry::<String>(&lines, "sensor"), "OV5640");
    assert_eq!(entry::<String>(&lines, "hand"), "tracked");
    // The marker of the hand's position is in the lower right corner.
    console.command("gesture mark").unwrap();
    run(&mut console, 40);
    let frame = console.board().inner().monitor_frame(4).unwrap();
    let marks = frame.iter().filter(|&&colour| colour == 0x07e0).count();
    assert!((16..40).contains(&marks), "{marks}");
}
