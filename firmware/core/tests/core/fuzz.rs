//! Gives mutations of valid inputs to every parser of external data.
//!
//! A fixed seed makes a run repeatable. The environment variable `GLINT_FUZZ_INPUTS` sets the number of inputs that each parser
//! gets (20,000 by default). The overflow checks of the dev profile turn an overflow into a panic.

use glint_core::calibration::Units;
use glint_core::console::{Command, Event, LineEditor};
use glint_core::mesh::{IndexedTriangle, Mesh, Rgb565, Vertex, encode};
use glint_core::orientation::Sample;
use glint_core::orientation::log::{self, HEADER_BYTES, RECORD_BYTES, Setup, record, to_bytes};
use glint_core::wire::{MAX_FRAME, Manifest, Receiver, Sender, State, Timing};
use glint_core::wireframe::{Program, text};

/// The longest input in bytes.
const LONGEST: usize = 4 << 10;

struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 16
    }

    fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit.max(1) as u64) as usize
    }
}

/// Calls `target`, which runs a parser, with mutations of the inputs in `corpus`.
fn fuzz(corpus: &[Vec<u8>], mut target: impl FnMut(&[u8], &mut Random)) {
    let inputs =
        std::env::var("GLINT_FUZZ_INPUTS").map_or(20_000, |count| count.parse().expect("a number"));
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let mut input = Vec::new();
    for _ in 0..inputs {
        input.clone_from(&corpus[random.below(corpus.len())]);
        for _ in 0..random.below(8) {
            mutate(&mut input, corpus, &mut random);
        }
        input.truncate(LONGEST);
        target(&input, &mut random);
    }
}

fn mutate(input: &mut Vec<u8>, corpus: &[Vec<u8>], random: &mut Random) {
    const INTERESTING: [u8; 12] = [0, 1, 2, 3, 0x1B, b'\r', b'-', b'9', 0x7F, 0x80, 0xFE, 0xFF];
    let place = random.below(input.len() + 1);
    let end = (place + random.below(64)).min(input.len());
    match random.below(8) {
        0 => input.truncate(place),
        1 => drop(input.drain(place..end)),
        2 => {
            let repeated = input[place..end].to_vec();
            input.splice(place..place, repeated);
        }
        3 => {
            let other = &corpus[random.below(corpus.len())];
            let from = random.below(other.len());
            input.splice(
                place..end,
                other[from..].iter().copied().take(random.below(64)),
            );
        }
        4 => input.insert(place, INTERESTING[random.below(INTERESTING.len())]),
        5 => input[place..end]
            .iter_mut()
            .take(4)
            .for_each(|byte| *byte = INTERESTING[random.below(INTERESTING.len())]),
        6 => input[place..end]
            .iter_mut()
            .take(1)
            .for_each(|byte| *byte ^= 1 << random.below(8)),
        _ => input[place..end]
            .iter_mut()
            .take(4)
            .for_each(|byte| *byte = random.next() as u8),
    }
}

fn vertices(count: u32) -> Vec<Vertex> {
    let vertex = |i: u32| Vertex {
        position: [i as i16, 1_000, -5_000],
        normal: [0, 0, 1 << 14],
        colour: Rgb565(i as u16),
    };
    (0..count).map(vertex).collect()
}

#[test]
fn meshes() {
    let triangle = |i: u32| IndexedTriangle {
        indices: [i, i + 1, i + 2],
        ..IndexedTriangle::default()
    };
    let mesh = |count: u32| {
        let triangles: Vec<_> = (0..count - 2).map(triangle).collect();
        encode(&vertices(count), &triangles).expect("a good mesh")
    };
    // A mesh of two chunks, with three vertices and one triangle each.
    let mut two = mesh(3);
    two[4] = 32 + 5 * 16 * 2;
    two[8] = 2;
    two[12] = 6;
    two[16] = 2;
    two.extend_from_within(32..);
    assert!(Mesh::new_checked(&two).is_ok());
    let mut passed = 0;
    fuzz(&[mesh(3), mesh(40), mesh(120), two], |bytes, _| {
        if let Ok(mesh) = Mesh::new_checked(bytes) {
            passed += 1;
            let mut counts = [0; 2];
            for chunk in mesh.chunks() {
                counts[0] += chunk.vertices().count();
                counts[1] += chunk.triangles().count();
                let indices = chunk.triangles().flat_map(|triangle| triangle.indices);
                indices.for_each(|i| assert!(chunk.vertex(i.into()).is_some()));
            }
            assert_eq!(
                counts.map(|count| count as u32),
                [mesh.vertex_count(), mesh.triangle_count()]
            );
        }
    });
    println!("{passed} passed");
    assert!(passed > 0);
}

#[test]
fn logs() {
    let image = |samples: u32, flags: [bool; 2]| {
        let setup = Setup::new(Units::MPU_6050, flags[0], flags[1], [256, 0, -7]).expect("a setup");
        let mut log = setup.header(samples).to_vec();
        for i in 0..samples {
            log.extend(to_bytes(record(&Sample {
                t_us: 0xFFFF_F000 + 1_000 * u64::from(i),
                accel: [i as i16, 100, 4_000],
                gyro: [-(i as i16), 300, i as i16 * 100],
            })));
        }
        log
    };
    let corpus = [
        image(1, [true, true]),
        image(40, [true, false]),
        image(200, [false, true]),
    ];
    let mut passed = 0;
    fuzz(&corpus, |bytes, random| {
        let mut bytes = bytes.to_vec();
        // Most mutations make the length wrong, so here half of the inputs get a number of samples that suits their length.
        if let (Some(rest), true) = (bytes.len().checked_sub(HEADER_BYTES), random.below(2) == 0) {
            let samples = rest / RECORD_BYTES;
            bytes[4..8].copy_from_slice(&(samples as u32).to_le_bytes());
            bytes.truncate(HEADER_BYTES + RECORD_BYTES * samples);
        }
        match log::replay(&mut bytes) {
            Ok(_) => {
                passed += 1;
                let mut records = bytes[HEADER_BYTES..].as_chunks().0.iter();
                assert!(records.all(|record| log::attitude(log::from_bytes(record)).is_some()));
            }
            Err(error) => assert!(error.to_string().starts_with("log: expected ")),
        }
    });
    println!("{passed} passed");
    assert!(passed > 0);
}

const PROGRAM: &str = "# two\neye 0 0 8\nplane 4\nwindow -4 -2.25 4 2.25\nsegment -1 -1 0 1 -1 0\nsegment 1 -1 -15.9 0 16e-1 0\nend\n";

#[test]
fn wireframe_words() {
    let small = text::assemble(PROGRAM).expect("a good program");
    let mut large = small.clone();
    (0..100).for_each(|_| drop(large.splice(48..48, small[48..64].to_vec())));
    let mut passed = 0;
    fuzz(&[small, large], |bytes, _| {
        match Program::new_checked(bytes) {
            Ok(program) => {
                passed += 1;
                assert_eq!(program.segments().count(), program.segment_count() as usize);
                let lines: String = program
                    .instructions()
                    .map(|line| format!("{line}\n"))
                    .collect();
                assert!(text::assemble(&lines).is_ok());
            }
            Err(error) => {
                assert!(error.to_string().starts_with("wireframe program, word "));
            }
        }
    });
    println!("{passed} passed");
    assert!(passed > 0);
}

#[test]
fn wireframe_texts() {
    let mut passed = 0;
    fuzz(
        &[PROGRAM.as_bytes().to_vec()],
        |bytes, _| match text::assemble(&String::from_utf8_lossy(bytes)) {
            Ok(bytes) => {
                passed += 1;
                assert!(Program::new_checked(&bytes).is_ok());
            }
            Err(error) => {
                let error = error.to_string();
                assert!(error.starts_with("wireframe program, line ") && error.is_ascii());
            }
        },
    );
    println!("{passed} passed");
    assert!(passed > 0);
}

#[test]
fn console() {
    let lines = [
        "help view\rhelp\r",
        "camera 3.5 -90 60\rlook 1e1 -.5 +7\r",
        "view 0 0 3 1 0 0 0 -1 0 0 0 -1 0.9 0.1\r",
        "view 1.2345678901 -7.9999999999 0.0000000002 0.70710678 0.70710678 0 0 0 -1 -0.7 0.7 0 4 2\r",
        "replay\rreplay 4096 deadbeef\rload 33554432 deadbeef\rsize 1280 720\rleds 0xffff\r",
        "orbit 36\x1B[A\x1B[D\x1B[3~\x7F\r\x1B[A\x1B[A\x1B[B\x1B[H\x0B\x15\x17\x0C\x03",
        "field menger:4\rfield box:1,0.5,.25\rfield off\rstereo 0.05,3,red-cyan\rstereo off\r",
        "cull on\rprepass off\rstats json\rbackend cpu\rshading smooth\rbench sine\rscene a-very-long-name-of-a-scene\r",
    ];
    let mut corpus = lines.map(|line| line.as_bytes().to_vec()).to_vec();
    corpus.push([b'x'; 700].to_vec());
    let mut parsed = 0;
    fuzz(&corpus, |bytes, _| {
        let (mut editor, mut echo) = (LineEditor::new(), String::new());
        for &byte in bytes {
            if let Event::Line(line) = editor.on_byte(byte, &mut echo) {
                match Command::parse(line) {
                    Ok(_) => parsed += 1,
                    Err(error) => assert!(!error.to_string().is_empty()),
                }
            }
        }
        assert!(echo.bytes().all(|byte| byte.is_ascii()));
    });
    println!("{parsed} parsed");
    assert!(parsed > 0);
}

/// Runs a transfer without errors, and returns the bytes sent in both directions.
fn transfer(data: &[u8], session: u8) -> [Vec<u8>; 2] {
    let mut buffer = vec![0; data.len()];
    let mut sender = Sender::new(data, session, Timing::HOST, 0);
    let mut receiver = Receiver::new(&mut buffer, None, Timing::CONSOLE, 0);
    let mut streams = [Vec::new(), Vec::new()];
    let mut frame = [0; MAX_FRAME];
    for now_ms in 0..100 {
        let length = sender.poll(now_ms, &mut frame);
        receiver.on_bytes(now_ms, &frame[..length]);
        streams[0].extend_from_slice(&frame[..length]);
        let length = receiver.poll(now_ms, &mut frame);
        sender.on_bytes(now_ms, &frame[..length]);
        streams[1].extend_from_slice(&frame[..length]);
    }
    assert_eq!(
        (sender.state(), receiver.state()),
        (State::Done, State::Done)
    );
    streams
}

#[test]
fn receiver() {
    let data: Vec<u8> = (0..1_500_u32).map(|i| (i * i / 8) as u8).collect();
    let corpus = [
        transfer(&data, 1),
        transfer(&data[..100], 2),
        transfer(&[], 3),
    ]
    .map(|[said, _]| said);
    let manifest = Manifest::of(&data);
    let mut done = 0;
    let mut buffer = vec![0; data.len()];
    fuzz(&corpus, |bytes, random| {
        let announced = (random.below(2) == 0).then_some(manifest);
        let mut receiver = Receiver::new(&mut buffer, announced, Timing::CONSOLE, 0);
        let mut frame = [0; MAX_FRAME];
        let mut now_ms = 0;
        for part in bytes.chunks(1 + random.below(400)) {
            now_ms += 1 + random.next() % 50;
            receiver.on_bytes(now_ms, part);
            receiver.poll(now_ms, &mut frame);
        }
        for _ in 0..20 {
            now_ms += 3_000;
            receiver.poll(now_ms, &mut frame);
        }
        assert_ne!(receiver.state(), State::Running);
        if let Some(received) = receiver.received() {
            done += 1;
            assert!([&data[..], &data[..100], &[]].contains(&received));
        }
    });
    println!("{done} done");
    assert!(done > 0);
}

#[test]
fn sender() {
    let data: Vec<u8> = (0..1_500_u32).map(|i| (i * i / 8) as u8).collect();
    let corpus = [transfer(&data, 1), transfer(&data[..100], 1)].map(|[_, heard]| heard);
    let mut done = 0;
    fuzz(&corpus, |bytes, random| {
        let mut sender = Sender::new(&data, 1, Timing::HOST, 0);
        let mut frame = [0; MAX_FRAME];
        let mut now_ms = 0;
        for part in bytes.chunks(1 + random.below(40)) {
            now_ms += 1 + random.next() % 50;
            for _ in 0..random.below(20) {
                assert!(sender.poll(now_ms, &mut frame) <= MAX_FRAME);
            }
            sender.on_bytes(now_ms, part);
        }
        for _ in 0..20 {
            now_ms += 6_000;
            sender.poll(now_ms, &mut frame);
        }
        done += u32::from(sender.state() == State::Done);
        assert_ne!(sender.state(), State::Running);
    });
    println!("{done} done");
    assert!(done > 0);
}
