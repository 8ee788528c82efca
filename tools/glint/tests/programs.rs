//! The example programs, with scripted buttons and switches, on the emulated board; one also on the virtual board. The size of a new
//! project.

use glint::board::{self, EmulatedBoard, SimulatedBoard, Simulation};
use glint::gesture;
use glint::imu::log::Entry;
use glint::imu::sensor;
use glint::program;
use glint_board_api::{Frame, Uart, built};
use glint_core::colour::Rgb565;
use glint_core::digits;
use glint_live_page::Places;
use litex_pac::BUILD_ID;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};
use virtual_board::virtual_image_sensor::{Hand, ImageSensor, Scene};
use virtual_board::virtual_mpu6050::Wires;

/// Clock cycles in a hundredth of a second.
const CENTISECOND: u64 = 812_500;
/// Longest time until an expected text.
const LIMIT: u64 = 20 * 81_250_000;

/// The ELF file of a program.
fn elf(name: &str) -> Vec<u8> {
    let file = format!("firmware/programs/{name}.elf");
    fs::read(built::find(&file, "cargo xtask programs").unwrap()).unwrap()
}

/// The memory image of a program.
fn image(name: &str) -> Vec<u8> {
    let file = format!("firmware/programs/{name}.elf");
    program::read(&built::find(&file, "cargo xtask programs").unwrap())
        .unwrap()
        .image
}

fn start(name: &str) -> SimulatedBoard<EmulatedBoard> {
    board::emulated(&image(name)).unwrap()
}

/// Runs for a time in hundredths of a second, with these buttons held, and returns the frame on the monitor.
fn run_for(board: &mut SimulatedBoard<EmulatedBoard>, buttons: u8, centiseconds: u64) -> Frame {
    board.inner().set_buttons(buttons);
    board.run(centiseconds * CENTISECOND);
    let (_, frame) = board.inner().new_frame(0).unwrap().unwrap();
    frame
}

/// Number of pixels of a frame for which `is_wanted` is true.
fn count(frame: &Frame, is_wanted: impl Fn([u8; 3]) -> bool) -> usize {
    let colours = frame.pixels.iter().map(|&pixel| Rgb565(pixel).to_rgb888());
    colours.filter(|&colour| is_wanted(colour)).count()
}

/// The output since the last call.
fn said(board: &mut SimulatedBoard<EmulatedBoard>) -> String {
    String::from_utf8_lossy(&std::mem::take(board.inner().uart_output())).into_owned()
}

#[test]
fn the_cube_turns_and_stands_while_the_button_is_down() {
    let mut board = start("cube");
    let first = run_for(&mut board, 0, 20);
    let second = run_for(&mut board, 0, 10);
    assert_ne!(first, second);
    let held = run_for(&mut board, 1, 10);
    assert_eq!(run_for(&mut board, 1, 20), held);
    assert_ne!(run_for(&mut board, 0, 10), held);
    // The left half of the digits shows the pictures per second.
    assert_ne!(board.inner().digits()[..4], [0; 4]);
    assert!(said(&mut board).contains("cube: hold button 0 to stop it\r\n"));
}

#[test]
fn the_solar_system_has_a_sun_and_stops_at_speed_0() {
    let mut board = start("solar");
    let before = run_for(&mut board, 0, 20);
    assert!(count(&before, |[r, g, b]| r > 200 && g > 150 && b < 160) > 2_000);
    // Each press of button 1 halves the speed: 8, 4, 2, 1, 0 eighths.
    for _ in 0..4 {
        run_for(&mut board, 2, 4);
        run_for(&mut board, 0, 4);
    }
    let standing = run_for(&mut board, 0, 10);
    assert_eq!(run_for(&mut board, 0, 10), standing);
    run_for(&mut board, 4, 4);
    assert_ne!(run_for(&mut board, 0, 20), standing);
}

#[test]
fn the_flight_turns_by_the_buttons_or_the_sensor() {
    let mut board = start("flight");
    let ahead = run_for(&mut board, 0, 15);
    // The sky at the end of the tunnel is in the middle of the picture.
    let is_sky = |[_, _, b]: [u8; 3]| b > 200;
    // A sixteenth of a turn to the right, the end is aside.
    let aside = run_for(&mut board, 8, 50);
    let in_middle = |frame: &Frame| frame.pixels[frame.pixels.len() / 2 + frame.width / 2];
    let [ahead, aside] = [ahead, aside].map(|frame| Rgb565(in_middle(&frame)).to_rgb888());
    assert!(is_sky(ahead) && !is_sky(aside), "{ahead:?}, {aside:?}");

    let mut board = start("flight");
    board.inner().plug(sensor::virtual_sensor(None));
    let by_sensor = run_for(&mut board, 0, 40);
    // The buttons have no effect while a sensor steers: the sensor looks ahead, to the sky at the end.
    let turned_by_button = run_for(&mut board, 8, 50);
    for frame in [by_sensor, turned_by_button] {
        assert!(is_sky(Rgb565(in_middle(&frame)).to_rgb888()));
    }
}

#[test]
fn the_fighter_ends_after_three_crashes_and_starts_again() {
    let mut board = start("fighter");
    run_for(&mut board, 8, 1);
    let text = board.inner().read_until("lives 0\r\n", LIMIT).unwrap();
    assert!(
        text.contains("lives 2\r\n") && text.contains("lives 1\r\n"),
        "{text}"
    );
    let over = run_for(&mut board, 0, 10);
    assert!(
        count(&over, |[r, g, _]| r > 200 && g < 50) > 300,
        "red text"
    );
    assert_eq!(board.inner().leds(), 0);
    run_for(&mut board, 1, 10);
    assert!(said(&mut board).contains("fly through the gates"));
    assert_eq!(board.inner().leds(), 7);
}

/// An image sensor with a hand at this position in its frame.
fn hand_at(centre: [f64; 2]) -> ImageSensor {
    let area = 320.0 * 240.0 * 0.06;
    let mut scene = Scene::new([320, 240], move |_| vec![Hand { centre, area }]);
    scene.noise = 2.0;
    gesture::image_sensor(scene)
}

#[test]
fn a_hand_turns_the_torus() {
    let mut board = start("hand");
    board.inner().plug_image_sensor(hand_at([100.0, 90.0]));
    run_for(&mut board, 0, 60);
    assert_eq!(board.inner().leds(), 1);
    // Pixels that differ clearly: the noise of the sensor moves the torus slightly.
    let difference = |a: &Frame, b: &Frame| {
        let green = |pixel: u16| Rgb565(pixel).to_rgb888()[1];
        let pairs = a.pixels.iter().zip(&b.pixels);
        pairs
            .filter(|&(&a, &b)| green(a).abs_diff(green(b)) > 64)
            .count()
    };
    let [held, later] = [0; 2].map(|_| run_for(&mut board, 0, 20));
    let by_noise = difference(&held, &later);
    board.inner().plug_image_sensor(hand_at([220.0, 150.0]));
    run_for(&mut board, 0, 60);
    let moved = run_for(&mut board, 0, 20);
    let by_hand = difference(&held, &moved);
    assert!(
        by_hand > 10 * by_noise + 500,
        "{by_noise} and {by_hand} pixels"
    );
}

#[test]
fn the_bench_of_kernels_prints_its_cycles() {
    let mut board = start("kernel");
    for name in ["library", "digit by digit", "newton"] {
        let line = board
            .inner()
            .read_until("cycles per root\r\n", LIMIT)
            .unwrap();
        let cycles = line.rsplit_once(&format!("{name}: ")).unwrap().1;
        let cycles: u32 = cycles.split_once(' ').unwrap().0.parse().unwrap();
        assert!((20..1_000).contains(&cycles), "{line}");
    }
}

#[test]
fn the_oscilloscope_draws_gravity_and_holds_its_picture() {
    let mut board = start("scope");
    let blank = run_for(&mut board, 0, 10);
    board.inner().plug(sensor::virtual_sensor(None));
    // The traces have a range of ±2 g, so the trace z, at 1 g, is halfway between the middle and the upper end: line 105 of 360.
    // `scale` is the enlargement of the picture.
    run_for(&mut board, 0, 150);
    let moving = run_for(&mut board, 0, 10);
    assert_ne!(moving, blank);
    let width = moving.width;
    let scale = moving.height / 360;
    let rows = moving.pixels.chunks(width);
    let is_z = |&pixel: &u16| {
        let [r, g, b] = Rgb565(pixel).to_rgb888();
        b > 200 && r < 100 && g > 100
    };
    let found: usize = rows
        .skip(95 * scale)
        .take(20 * scale)
        .flatten()
        .filter(|p| is_z(p))
        .count();
    assert!(found > 300 * scale, "{found} pixels of the trace z");
    run_for(&mut board, 4, 4);
    let held = run_for(&mut board, 0, 10);
    assert_eq!(board.inner().leds(), 1);
    assert_eq!(run_for(&mut board, 0, 20), held);
}

#[test]
fn recorded_commands_are_drawn_as_by_the_rasteriser_of_their_crate() {
    /// The background of the program.
    const BACKGROUND: Rgb565 = Rgb565::from_rgb888([24, 36, 56]);
    let mut board = start("commands");
    for scene in ["three cubes", "three spheres", "cube of lines"] {
        // The time stands still while button 0 is down.
        run_for(&mut board, 1, 20);
        let [own, engine] = [1, 2].map(|switches| {
            board.inner().set_switches(switches);
            let frame = run_for(&mut board, 1, 210);
            let text = said(&mut board);
            let line = text.lines().last().unwrap();
            assert!(line.contains(scene) && line.contains("320x180"), "{line}");
            // The number before a text.
            let cycles = |unit| {
                let before = line.split_once(unit).unwrap().0;
                before.rsplit_once(' ').unwrap().1.parse::<u32>().unwrap()
            };
            (frame, cycles(" to convert") + cycles(" to draw"))
        });
        let drawn = count(&engine.0, |colour| colour != BACKGROUND.to_rgb888());
        let pairs = own.0.pixels.iter().zip(&engine.0.pixels);
        let different = pairs.filter(|(own, engine)| own != engine).count();
        // The rasteriser also draws the pixels on the lower and right edges.
        assert!(drawn > 400, "{scene}: {drawn} pixels");
        assert!(different < 800, "{scene}: {different} pixels differ");
        assert!(own.1 > 5 * engine.1, "{scene}: {} and {}", own.1, engine.1);
        // Button 3 shows the next scene.
        run_for(&mut board, 9, 20);
    }
}

#[test]
fn faults_are_told_by_name_and_enter_restarts() {
    let mut board = start("faults");
    let mut places = Places::new(elf("faults"));
    for (switches, fault, place) in [
        (1, "panicked at firmware/program/../examples/faults.rs", ""),
        (
            1 << 1,
            "no picture for 10 seconds: an endless loop? at 0x40",
            "examples/faults.rs:",
        ),
        (1 << 2, "stack overflow: ", " is in "),
        (
            1 << 3,
            "picture: matrix row 1: (0, 0, 0): expected a length",
            "",
        ),
        (
            1 << 4,
            "trap: illegal instruction (mcause 2) at 0x40",
            "examples/faults.rs:",
        ),
    ] {
        board
            .inner()
            .read_until("switches 0 to 4\r\n", LIMIT)
            .unwrap();
        board.inner().set_switches(switches);
        let text = board
            .inner()
            .read_until("press Enter to restart\r\n", LIMIT);
        let text = text.unwrap();
        assert!(text.contains(fault), "expected {fault:?} in {text}");
        let found = places.hear(text.as_bytes()).unwrap_or_default();
        assert!(found.contains(place), "expected {place:?} in {found:?}");
        assert_eq!(found.is_empty(), place.is_empty(), "{found}");
        board.inner().set_switches(0);
        board.inner().uart_write(b"\r");
    }
    board
        .inner()
        .read_until("switches 0 to 4\r\n", LIMIT)
        .unwrap();
}

#[test]
fn a_program_for_other_gateware_is_refused_by_file_and_by_itself() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cube.elf");
    let mut file = elf("cube");
    let id = BUILD_ID.to_le_bytes();
    let starts: Vec<_> = (0..file.len() - 4)
        .filter(|&at| file[at..at + 4] == id)
        .collect();
    for &at in &starts {
        file[at] ^= 0xff;
    }
    fs::write(&path, &file).unwrap();
    let error = program::read(&path).unwrap_err().to_string();
    let other = BUILD_ID ^ 0xff;
    let expected = format!(
        "found a program for gateware {other:#010x}, while these boards have {BUILD_ID:#010x}"
    );
    assert!(error.contains(&expected), "{error}");

    let mut image = image("cube");
    let starts: Vec<_> = (0..image.len() - 4)
        .filter(|&at| image[at..at + 4] == id)
        .collect();
    for at in starts {
        image[at] ^= 0xff;
    }
    let mut board = board::emulated(&image).unwrap();
    let text = board
        .inner()
        .read_until("press Enter to restart\r\n", LIMIT);
    let text = text.unwrap();
    let expected = format!("built for gateware {other:#010x}, found {BUILD_ID:#010x}");
    assert!(text.contains(&expected), "{text}");
}

#[test]
fn elf_files_of_other_programs_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("other.elf");
    let mut file = elf("kernel");
    // Without the names of its symbols, the file was not linked with Glint's memory map.
    let name = b"_windows_end\0";
    let at = file
        .windows(name.len())
        .position(|part| part == name)
        .unwrap();
    file[at] = b'x';
    fs::write(&path, &file).unwrap();
    let error = program::read(&path).unwrap_err().to_string();
    assert!(error.contains("without the symbol _windows_end"), "{error}");
    // A segment far away from the program would make an image of gigabytes.
    let mut file = elf("kernel");
    let headers = u32::from_le_bytes(file[28..32].try_into().unwrap()) as usize;
    let count = u16::from_le_bytes([file[44], file[45]]).into();
    let mut starts = (0..count).map(|i| headers + 32 * i);
    let load = starts.find(|&at| file[at] == 1 && file[at + 16..at + 20] != [0; 4]);
    let load = load.unwrap();
    file[load + 12..load + 16].copy_from_slice(&0xffff_0000_u32.to_le_bytes());
    fs::write(&path, &file).unwrap();
    let error = program::read(&path).unwrap_err().to_string();
    assert!(
        error.contains("outside of the program's part of main memory"),
        "{error}"
    );
    fs::write(&path, &file[..1000]).unwrap();
    let error = program::read(&path).unwrap_err().to_string();
    assert!(error.contains("an ELF file that is damaged"), "{error}");
}

#[test]
fn the_fighter_takes_the_place_of_another_program_on_the_verilated_soc() {
    let mut board = board::verilated(&image("faults")).unwrap();
    board.inner().monitor().turn_on();
    board.inner().set_switches(1);
    let halt = "press Enter to restart\r\n";
    board.inner().read_until(halt, LIMIT).unwrap();
    // The switch stays on.
    let cycles = board.inner().cycles();
    board.inner().boot(&image("faults")).unwrap();
    board.inner().read_until(halt, LIMIT).unwrap();
    assert!(board.inner().cycles() > cycles);
    board.inner().boot(&image("fighter")).unwrap();
    board
        .inner()
        .read_until("fly through the gates\r\n", LIMIT)
        .unwrap();
    // The first frames on the monitor are black.
    let mut last = 0;
    let is_shown = board.inner().run_until(LIMIT, |board| {
        let frame = board.new_frame(last).unwrap();
        frame.is_some_and(|(number, frame)| {
            last = number;
            count(&frame, |[r, g, b]| g > 100 && r < 50 && b < 50) > 500
        })
    });
    assert!(is_shown);
}

/// The programs of docs/program-sizes.md, with the buttons that are held for their pictures.
const PROGRAMS: [(&str, u8); 8] = [
    ("cube", 0),
    ("solar", 0),
    ("flight", 0),
    ("fighter", 8),
    ("hand", 0),
    ("kernel", 0),
    ("scope", 0),
    ("commands", 0),
];

/// Largest image of a new project in bytes: 80 KB.
const NEW_PROJECT: usize = 80_000;

/// The table of docs/program-sizes.md.
struct Table {
    path: PathBuf,
    page: String,
    /// Whether the table is written, and not compared.
    updates: bool,
}

impl Table {
    fn read(path: PathBuf) -> Self {
        Self {
            page: fs::read_to_string(&path).unwrap(),
            path,
            updates: env::var_os("GLINT_UPDATE").is_some(),
        }
    }

    /// Compares the row of a program with the measured numbers, or replaces the row.
    fn check(&mut self, name: &str, rate: u32, size: usize) {
        let start = self.page.find(&format!("\n| {name} | ")).unwrap() + 1;
        let end = start + self.page[start..].find('\n').unwrap();
        let cells: Vec<_> = self.page[start..end].split('|').map(str::trim).collect();
        let [_, _, picture, stated_rate, stated_size, _] = cells[..] else {
            panic!("{name}: {cells:?}");
        };
        if self.updates {
            let row = format!("| {name} | {picture} | {rate} | {size} |");
            self.page.replace_range(start..end, &row);
            return;
        }
        let is_near = |stated: &str, found: f64| {
            let stated: f64 = stated.replace(',', "").parse().unwrap();
            (stated - found).abs() < 0.05 * found
        };
        assert!(is_near(stated_size, size as f64), "{name}: {size} bytes");
        let rate_is_near = is_near(stated_rate, rate.into());
        assert!(rate_is_near, "{name}: {rate} pictures per second");
    }

    /// Writes the table if it is written.
    fn write(self) {
        if self.updates {
            fs::write(self.path, self.page).unwrap();
        }
    }
}

/// The number of pictures per second that the left half of the digits shows.
fn rate(board: &mut SimulatedBoard<EmulatedBoard>) -> u32 {
    let shown = board.inner().digits();
    let digit =
        |lit: &u8| (0..10).find(|&digit| digits::segments(char::from(b'0' + digit)) == *lit);
    let digits = shown[..4].iter().filter_map(digit);
    digits.fold(0, |number, digit| 10 * number + u32::from(digit))
}

/// A shaken sensor: damped swings along x and y, gravity along z.
fn shaken() -> Wires {
    let entries = (0..2_000).map(|t: i32| {
        let swing = |period: i32| {
            let phase = f64::from(t) * std::f64::consts::TAU / f64::from(period);
            (phase.sin() * 5_000.0 * (-f64::from(t % 700) / 250.0).exp()) as i16
        };
        Entry {
            line: 0,
            t_us: 1_000 * u64::from(t.unsigned_abs()),
            accel: [swing(90), swing(140), 4096 + swing(45) / 4],
            gyro: [0; 3],
            temp: None,
        }
    });
    sensor::virtual_sensor(Some(&entries.collect::<Vec<_>>()))
}

/// Colours of a picture of 640×360 pixels: means of squares of the frame's pixels.
fn of_page(frame: &Frame) -> Vec<u8> {
    let scale = frame.width / 640;
    assert_eq!([frame.width, frame.height], [640 * scale, 360 * scale]);
    let at = |x: usize, y: usize| Rgb565(frame.pixels[y * frame.width + x]).to_rgb888();
    let mean = |column: usize, row: usize, channel: usize| {
        let places =
            (0..scale * scale).map(|i| (column * scale + i % scale, row * scale + i / scale));
        let sum: usize = places.map(|(x, y)| usize::from(at(x, y)[channel])).sum();
        (sum / (scale * scale)) as u8
    };
    let pixels = (0..360).flat_map(|row| (0..640).map(move |column| (column, row)));
    pixels
        .flat_map(|(column, row)| [0, 1, 2].map(|channel| mean(column, row, channel)))
        .collect()
}

/// The image of a new project, as `cargo build --release` builds it.
fn new_project(root: &Path) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let made = Command::new(env!("CARGO_BIN_EXE_glint"))
        .args(["new", "sized", "--glint"])
        .arg(root)
        .current_dir(&folder)
        .output()
        .unwrap();
    assert!(made.status.success(), "{made:?}");
    let target = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let built = Command::new("cargo")
        .args(["build", "--release", "--offline", "--quiet"])
        .current_dir(folder.path().join("sized"))
        // The library is compiled once for all runs of the tests.
        .env("CARGO_TARGET_DIR", target)
        // Cargo sets variables of the tested package, which do not concern the project.
        .env_remove("CARGO_MANIFEST_DIR")
        .output()
        .unwrap();
    assert!(built.status.success(), "{built:?}");
    let elf = target.join("riscv32im-unknown-none-elf/release/sized");
    program::read(&elf).unwrap().image
}

#[test]
fn the_pages_of_programs_show_their_pictures_sizes_and_rates() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut table = Table::read(root.join("docs/program-sizes.md"));
    let pages = ["docs/programs.md", "docs/gallery.md"];
    let pages = pages.map(|page| fs::read_to_string(root.join(page)).unwrap());
    for (name, buttons) in PROGRAMS {
        let shows = format!("](pictures/program-{name}.png)");
        assert!(pages.iter().all(|page| page.contains(&shows)), "{name}");
        let image = image(name);
        let mut board = board::emulated(&image).unwrap();
        match name {
            "scope" => board.inner().plug(shaken()),
            "hand" => board.inner().plug_image_sensor(hand_at([90.0, 100.0])),
            _ => {}
        }
        let frame = run_for(&mut board, buttons, 140);
        // A program from another compiler version draws its frames at slightly different times, so the pictures may differ slightly.
        let shown = root.join(format!("docs/pictures/program-{name}.png"));
        let found = of_page(&frame);
        if table.updates {
            let mut encoder = png::Encoder::new(File::create(&shown).unwrap(), 640, 360);
            encoder.set_color(png::ColorType::Rgb);
            encoder.set_compression(png::Compression::High);
            encoder
                .write_header()
                .unwrap()
                .write_image_data(&found)
                .unwrap();
        }
        let file = BufReader::new(File::open(&shown).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut expected = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut expected).unwrap();
        assert_eq!(expected.len(), found.len(), "{name}");
        let pairs = expected.iter().zip(&found);
        let difference: u64 = pairs.map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
        let mean = difference as f64 / found.len() as f64;
        assert!(
            mean < 8.0,
            "{name}: mean difference of {mean:.1} of 255 to docs/pictures"
        );

        table.check(name, rate(&mut board), image.len());
    }
    let image = new_project(&root);
    assert!(image.len() < NEW_PROJECT, "{} bytes", image.len());
    let mut board = board::emulated(&image).unwrap();
    run_for(&mut board, 0, 140);
    table.check("`glint new`", rate(&mut board), image.len());
    table.write();
}
