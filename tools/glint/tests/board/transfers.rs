//! Transfers at the speed of a serial line that run concurrently with other tasks, such as reading
//! the motion sensor at 1 kHz.

use glint::board::{Simulation, Uart};
use std::collections::{HashSet, VecDeque};
use std::hash::{DefaultHasher, Hash, Hasher};

use crate::alone::{MS, press};
use crate::common::mesh;
use glint::board::{Board, BoardError, EmulatedBoard, built_firmware};
use glint::console::Console;
use glint::transfer;
use glint_core::console::PROMPT;
use virtual_board::virtual_mpu6050::{Chip, Fault, Imperfections, Source, State, Wires};

/// Number of clock cycles of a byte on a line with 1 Mbaud, 8N1.
const BYTE: u64 = 10 * MS / 1_000;
/// Interval in cycles at which picture and LEDs are sampled: six vertical blankings.
const SAMPLE_PERIOD: u64 = 100 * MS;
/// Number of cycles without an answer after which the board counts as failed.
const PATIENCE: u64 = 60_000 * MS;
/// A mesh of 1 MB.
const LARGE: &str = "icosphere:46";

/// A board on a serial line, with samples of its picture and LEDs during transfers.
struct Line {
    board: EmulatedBoard,
    to_board: VecDeque<u8>,
    from_board: VecDeque<u8>,
    /// Bytes from the board that have arrived at the host.
    arrived: Vec<u8>,
    /// Cycle of the last byte to the board.
    last_byte: u64,
    /// Hashes of the sampled pictures.
    pictures: Vec<u64>,
    /// Sampled states of the LEDs.
    leds: HashSet<u16>,
    next_sample: u64,
}

impl Line {
    /// A started board with a motion sensor that turns at 20° per second.
    fn start() -> Self {
        let mut board = EmulatedBoard::fast(&built_firmware(None).unwrap()).unwrap();
        let motion = |_| State {
            rate: [0.0, 0.0, 20.0],
            ..State::default()
        };
        let source = Source::Motion(Box::new(motion));
        board.plug(Wires::new(Chip::new(source, Imperfections::TYPICAL, 1)));
        board.read_until(PROMPT, PATIENCE).unwrap();
        board.run(200 * MS);
        Self {
            board,
            to_board: VecDeque::new(),
            from_board: VecDeque::new(),
            arrived: Vec::new(),
            last_byte: 0,
            pictures: Vec::new(),
            leds: HashSet::new(),
            next_sample: 0,
        }
    }

    /// Returns the reply to a command, without the delay of the line.
    fn say(&mut self, line: &str) -> String {
        self.board.run(10 * MS);
        self.board.uart_read(&mut self.arrived);
        self.arrived.clear();
        self.from_board.clear();
        self.board.uart_write(format!("{line}\r").as_bytes());
        // A note about the picture may repeat the prompt.
        let answer = self.board.read_until("ok\r\n", PATIENCE).unwrap();
        self.board.read_until(PROMPT, PATIENCE).unwrap();
        answer
    }

    /// Ends the steering by the sensor, and returns the number of samples that the sensor has
    /// measured but the firmware has not processed. The sensor is stalled while they are counted.
    fn lost(&mut self) -> u64 {
        self.say("imu off");
        self.board.run(500 * MS);
        let set = |board: &mut EmulatedBoard, fault| {
            let chip = &mut board.sensor().unwrap().chip;
            chip.fault = fault;
            chip.samples
        };
        let measured = set(&mut self.board, Some(Fault::Stalled));
        self.board.run(4 * MS);
        self.board.uart_write(b"imu\r");
        let answer = self.board.read_until(PROMPT, PATIENCE).unwrap();
        set(&mut self.board, None);
        assert!(answer.contains("failures 0\r\n"), "{answer}");
        let samples = answer
            .lines()
            .find_map(|line| line.strip_prefix("samples "));
        measured - samples.unwrap().parse::<u64>().unwrap()
    }

    fn run(&mut self) {
        if let Some(byte) = self.to_board.pop_front() {
            self.board.uart_write(&[byte]);
            self.last_byte = self.board.cycles();
        }
        self.board.run(BYTE);
        let mut sent = Vec::new();
        self.board.uart_read(&mut sent);
        self.from_board.extend(sent);
        self.arrived.extend(self.from_board.pop_front());
        if self.board.cycles() >= self.next_sample {
            self.next_sample = self.board.cycles() + SAMPLE_PERIOD;
            let mut hasher = DefaultHasher::new();
            self.board.shown().pixels.hash(&mut hasher);
            self.pictures.push(hasher.finish());
            self.leds.insert(self.board.leds());
        }
    }

    /// Calls `transfer`, and checks that the first LED has blinked. Returns the number of sampled
    /// pictures that differ from the previous picture, and the number of sampled pictures.
    fn watch(&mut self, transfer: impl FnOnce(&mut Console<Self>)) -> (usize, usize) {
        self.pictures.clear();
        self.leds.clear();
        self.next_sample = self.board.cycles();
        transfer(&mut Console::new(self));
        let blinks: HashSet<u16> = self.leds.iter().map(|leds| leds & 1).collect();
        assert_eq!(blinks.len(), 2, "the first LED blinks");
        let pairs = self.pictures.windows(2);
        let changes = pairs.filter(|pair| pair[0] != pair[1]).count();
        (changes, self.pictures.len() - 1)
    }
}

impl Board for Line {
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        self.to_board.extend(bytes);
        Ok(())
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        let end = self.board.cycles() + wait_ms * MS;
        while self.arrived.is_empty() && self.board.cycles() < end {
            self.run();
        }
        bytes.append(&mut self.arrived);
        Ok(())
    }

    fn now_ms(&self) -> u64 {
        self.board.cycles() / MS
    }
}

fn upload(console: &mut Console<Line>, mesh: &[u8]) {
    transfer::upload(console, mesh, None, 1, &mut |_, _| {}).unwrap();
}

#[test]
fn the_sensor_steers_the_picture_during_transfers() {
    let large = mesh(LARGE);
    assert!(large.len() > 1_000_000);
    let mut line = Line::start();
    let lost = line.lost();
    for command in ["size 320 180", "aa 1", "background 000000", "imu orbit"] {
        line.say(command);
    }
    let (changes, all) = line.watch(|console| upload(console, &large));
    assert_eq!(changes, all, "the picture follows");
    assert_eq!(line.lost(), lost, "samples were lost");
    assert!(line.say("info scene").contains("scene model"));

    line.say("scene cube");
    line.say("imu orbit");
    let mut frame = Vec::new();
    let (changes, all) = line.watch(|console| {
        frame = transfer::download(console, "frame", 2 * 320 * 180, &mut |_, _| {}).unwrap();
    });
    assert_eq!(changes, all, "the picture follows");
    assert_eq!(line.lost(), lost, "samples were lost");
    // The downloaded picture is a single picture, although the board drew others: a picture of the
    // cube has at most the colours of three faces and the background.
    let colours: HashSet<_> = frame.chunks(2).collect();
    assert!((2..=4).contains(&colours.len()), "{colours:?}");
}

#[test]
fn the_demo_goes_on_during_an_upload() {
    let large = mesh(LARGE);
    let mut line = Line::start();
    let lost = line.lost();
    line.say("demo on");
    press(&mut line.board, 0);
    assert!(line.say("demo").contains("scene 2 of 6"));
    let (changes, _) = line.watch(|console| upload(console, &large));
    assert!(changes > 0, "the next scene is shown");
    let scenes: HashSet<u16> = line.leds.iter().map(|leds| leds >> 4 & 0xf).collect();
    assert!(scenes.contains(&2) && scenes.contains(&3), "{scenes:?}");
    assert!(line.say("demo").contains("demo off"), "the upload is shown");
    assert!(line.say("info scene").contains("scene model"));
    assert_eq!(line.lost(), lost, "samples were lost");
}

/// The CPU takes longer to draw a picture than the board waits for the next byte of a transfer.
#[test]
fn an_upload_goes_on_while_the_cpu_draws() {
    let mesh = mesh("icosphere:10");
    let mut line = Line::start();
    let lost = line.lost();
    for command in ["backend cpu", "scene menger", "imu look"] {
        line.say(command);
    }
    let start = line.board.cycles();
    line.watch(|console| upload(console, &mesh));
    // The acknowledgements arrived in time, so the transfer did not wait for the end of a frame,
    // but the reply did.
    let (sent, all) = (line.last_byte - start, line.board.cycles() - start);
    assert!(sent < 2 * BYTE * mesh.len() as u64, "{sent} cycles");
    assert!(
        all > 2 * sent,
        "{all} cycles, {sent} of them for the transfer"
    );
    assert_eq!(line.lost(), lost, "samples were lost");
}
