//! Tests of transfers over a line that loses, changes and repeats bytes.

use std::collections::VecDeque;

use glint_core::wire::{Failure, MAX_FRAME, Manifest, Reason, Receiver, Sender, State, Timing};
use proptest::prelude::*;

/// Time in µs that a byte takes on the line at 115200 baud, 8N1.
const BYTE_US: f64 = 1e7 / 115_200.0;

/// Probabilities that a byte is lost, changed or repeated, in 1/10000.
#[derive(Clone, Copy, Debug, Default)]
struct Faults {
    drop: u64,
    flip: u64,
    duplicate: u64,
}

impl Faults {
    const fn new(drop: u64, flip: u64, duplicate: u64) -> Self {
        Self {
            drop,
            flip,
            duplicate,
        }
    }
}

/// One direction of a serial line.
struct Line {
    faults: Faults,
    random: u64,
    latency_us: f64,
    free_at_us: f64,
    on_the_way: VecDeque<(f64, u8)>,
}

impl Line {
    fn new(faults: Faults, seed: u64, latency_us: f64) -> Self {
        let random = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        Self {
            faults,
            random,
            latency_us,
            free_at_us: 0.0,
            on_the_way: VecDeque::new(),
        }
    }

    fn happens(&mut self, per_10000: u64) -> bool {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        self.random >> 32 & 0xFFFF_FFFF < per_10000 * (1 << 32) / 10_000
    }

    /// Whether the line's buffer has space for a frame.
    fn takes_more(&self, now_us: f64) -> bool {
        self.free_at_us - now_us < 512.0 * BYTE_US
    }

    fn send(&mut self, now_us: f64, bytes: &[u8]) {
        for &byte in bytes {
            self.free_at_us = self.free_at_us.max(now_us) + BYTE_US;
            let arrives = self.free_at_us + self.latency_us;
            let flip = u8::from(self.happens(self.faults.flip)) << (self.random >> 20 & 7);
            if !self.happens(self.faults.drop) {
                self.on_the_way.push_back((arrives, byte ^ flip));
            }
            if self.happens(self.faults.duplicate) {
                self.on_the_way.push_back((arrives, byte ^ flip));
            }
        }
    }

    fn receive(&mut self, now_us: f64) -> Vec<u8> {
        let due = self.on_the_way.partition_point(|&(at, _)| at <= now_us);
        self.on_the_way.drain(..due).map(|(_, byte)| byte).collect()
    }
}

/// Outcome of a transfer.
#[derive(Debug)]
struct TransferResult {
    sender: State,
    receiver: State,
    /// The received data; `None` if the transfer failed.
    received: Option<Vec<u8>>,
    seconds: f64,
    /// Largest number of data bytes in one of the last ten data frames.
    frame_bytes: usize,
}

impl TransferResult {
    /// Computes the line utilisation: the number of transferred data bytes divided by the number of bytes that the line can carry
    /// in this time.
    fn efficiency(&self) -> f64 {
        let bytes = self.received.as_ref().map_or(0, Vec::len);
        bytes as f64 * BYTE_US / 1e6 / self.seconds
    }
}

/// The conditions of a transfer from a host to a console.
struct Scene {
    faults: Faults,
    seed: u64,
    latency_us: f64,
    room: usize,
    announced: Option<Manifest>,
    sender_aborts_at_ms: u64,
    receiver_aborts_at_ms: u64,
    cut_at_ms: u64,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            faults: Faults::default(),
            seed: 1,
            latency_us: 2_000.0,
            room: 1 << 20,
            announced: None,
            sender_aborts_at_ms: u64::MAX,
            receiver_aborts_at_ms: u64::MAX,
            cut_at_ms: u64::MAX,
        }
    }
}

impl Scene {
    fn run(&self, data: &[u8]) -> TransferResult {
        let mut buffer = vec![0; self.room];
        let mut sender = Sender::new(data, 5, Timing::HOST, 0);
        let mut receiver = Receiver::new(&mut buffer, self.announced, Timing::CONSOLE, 0);
        let mut there = Line::new(self.faults, self.seed, self.latency_us);
        let mut back = Line::new(self.faults, self.seed + 1_000, self.latency_us);
        // Before the transfer, the line still carries earlier console output in one direction, and the end of the command line in
        // the other.
        back.send(0.0, b"glint> load 1234 deadbeef\r\nready\r\n");
        there.send(0.0, b"\n");
        let mut frame = [0; MAX_FRAME];
        let mut finished_ms = None;
        let mut sent = Vec::new();
        for now_ms in 0..3_600_000 {
            let now_us = now_ms as f64 * 1_000.0;
            if now_ms == self.sender_aborts_at_ms {
                sender.abort(now_ms);
            }
            if now_ms == self.receiver_aborts_at_ms {
                receiver.abort(now_ms);
            }
            let (arrived, answered) = (there.receive(now_us), back.receive(now_us));
            if now_ms < self.cut_at_ms {
                receiver.on_bytes(now_ms, &arrived);
                sender.on_bytes(now_ms, &answered);
            }
            while there.takes_more(now_us) {
                match sender.poll(now_ms, &mut frame) {
                    0 => break,
                    length => {
                        there.send(now_us, &frame[..length]);
                        // A frame has ten bytes besides its data: kind, numbers, CRC-16, COBS code and zeros. Only data frames have 16 or
                        // more bytes of data.
                        sent.extend(length.checked_sub(10).filter(|&bytes| bytes >= 16));
                    }
                }
            }
            while back.takes_more(now_us) {
                match receiver.poll(now_ms, &mut frame) {
                    0 => break,
                    length => back.send(now_us, &frame[..length]),
                }
            }
            if sender.state() != State::Running {
                finished_ms.get_or_insert(now_ms);
                if receiver.state() != State::Running {
                    break;
                }
            }
        }
        TransferResult {
            sender: sender.state(),
            receiver: receiver.state(),
            received: receiver.received().map(<[u8]>::to_vec),
            seconds: finished_ms.expect("the sender ends within an hour") as f64 / 1e3,
            frame_bytes: sent.into_iter().rev().take(10).max().unwrap_or(0),
        }
    }
}

/// Returns test data with bytes of every value, with zeros, and with long runs without a zero.
fn some_data(length: usize) -> Vec<u8> {
    (0..length as u32)
        .map(|i| (i.wrapping_mul(2_654_435_769) >> (i >> 10 & 15)) as u8)
        .collect()
}

#[track_caller]
fn assert_arrives(scene: &Scene, length: usize) -> TransferResult {
    let data = some_data(length);
    let outcome = scene.run(&data);
    let ends = (outcome.sender, outcome.receiver);
    assert_eq!(ends, (State::Done, State::Done));
    assert!(
        outcome.received.as_deref() == Some(&data),
        "received data differs from the sent data"
    );
    outcome
}

#[test]
fn every_length_arrives() {
    for length in (0..=33).chain([239, 240, 241, 1_023, 2_047, 2_048, 2_049, 4_096, 5_000]) {
        let scene = Scene {
            announced: Some(Manifest::of(&some_data(length))),
            ..Scene::default()
        };
        assert_arrives(&scene, length);
    }
}

#[test]
fn a_clean_line_is_used_to_85_percent() {
    for latency_us in [0.0, 2_000.0, 16_000.0, 50_000.0] {
        let scene = Scene {
            latency_us,
            ..Scene::default()
        };
        let outcome = assert_arrives(&scene, 64 << 10);
        let used = 100.0 * outcome.efficiency();
        println!("latency {latency_us} us: {used:.1} %");
        assert!(outcome.efficiency() >= 0.85, "{}", outcome.efficiency());
        assert_eq!(outcome.frame_bytes, 240);
    }
}

/// Sends data over a line with faults; prints and returns the line utilisation.
#[track_caller]
fn assert_arrives_in_spite_of(faults: Faults, seed: u64, length: usize) -> (f64, usize) {
    let scene = Scene {
        faults,
        seed,
        ..Scene::default()
    };
    let outcome = assert_arrives(&scene, length);
    let (used, frames) = (outcome.efficiency(), outcome.frame_bytes);
    println!("{faults:?}: {:.1} %, frames of {frames}", 100.0 * used);
    (used, frames)
}

#[test]
fn one_percent_of_bytes_lost_changed_or_repeated_does_no_harm() {
    let one = 100;
    for (faults, least) in [
        (Faults::new(one, 0, 0), 0.4),
        (Faults::new(0, one, 0), 0.4),
        (Faults::new(0, 0, one), 0.4),
        (Faults::new(one, one, one), 0.2),
    ] {
        for seed in 1..=4 {
            let (used, frames) = assert_arrives_in_spite_of(faults, seed, 40_000);
            assert!(used >= least, "{faults:?} {seed}: {used}");
            assert!(frames <= 48);
        }
    }
}

#[test]
fn a_rarely_hit_line_gets_frames_in_between() {
    let (used, _) = assert_arrives_in_spite_of(Faults::new(5, 5, 0), 1, 100_000);
    assert!(used >= 0.7, "{used}");
}

#[test]
fn an_awful_line_is_slow_and_right_or_given_up() {
    for seed in 1..=4 {
        assert_arrives_in_spite_of(Faults::new(150, 150, 150), seed, 2_000);
    }
    let lossy = Scene {
        faults: Faults::new(5_000, 0, 0),
        ..Scene::default()
    };
    let silence = Failure::Silence(Timing::CONSOLE.silence_ms);
    assert_ends(&lossy, 2_000, Failure::Silence(5_000), silence);
}

/// Runs a transfer, and checks that it fails on both sides, with the given causes.
fn assert_ends(scene: &Scene, length: usize, sender: Failure, receiver: Failure) {
    let outcome = scene.run(&some_data(length));
    let ends = (outcome.sender, outcome.receiver);
    assert_eq!(ends, (State::Failed(sender), State::Failed(receiver)));
    assert_eq!(outcome.received, None);
}

#[test]
fn a_side_that_gives_up_is_heard() {
    let cancelled = Failure::Aborted(Reason::Cancelled);
    let by_peer = Failure::AbortedByPeer(Reason::Cancelled);
    let by_sender = Scene {
        sender_aborts_at_ms: 500,
        ..Scene::default()
    };
    assert_ends(&by_sender, 50_000, cancelled, by_peer);
    let by_receiver = Scene {
        receiver_aborts_at_ms: 500,
        ..Scene::default()
    };
    assert_ends(&by_receiver, 50_000, by_peer, cancelled);
}

#[test]
fn a_cut_line_ends_both_sides() {
    let cut = Scene {
        cut_at_ms: 500,
        ..Scene::default()
    };
    let silence = Failure::Silence(Timing::CONSOLE.silence_ms);
    assert_ends(&cut, 50_000, Failure::Silence(5_000), silence);
}

#[test]
fn what_was_not_announced_or_does_not_fit_is_refused() {
    let Manifest { length, crc32 } = Manifest::of(&some_data(1_000));
    for (announced, room, reason) in [
        (Some((999, crc32)), 1 << 20, Reason::Unannounced),
        (Some((length, 1)), 1 << 20, Reason::Unannounced),
        (None, 999, Reason::TooLong),
    ] {
        let scene = Scene {
            announced: announced.map(|(length, crc32)| Manifest { length, crc32 }),
            room,
            ..Scene::default()
        };
        let by_peer = Failure::AbortedByPeer(reason);
        assert_ends(&scene, 1_000, by_peer, Failure::Aborted(reason));
    }
}

#[test]
fn the_host_keeps_the_text_that_follows() {
    let data = some_data(300);
    let mut buffer = vec![0; 300];
    let mut sender = Sender::new(&data, 0, Timing::CONSOLE, 0);
    let mut receiver = Receiver::new(&mut buffer, None, Timing::HOST, 0);
    let mut frame = [0; MAX_FRAME];
    let mut to_host = Vec::new();
    for now_ms in 0..1_000 {
        let length = sender.poll(now_ms, &mut frame);
        to_host.extend_from_slice(&frame[..length]);
        if sender.state() == State::Done {
            to_host.extend_from_slice(b"ok\r\n");
            break;
        }
        if receiver.state() == State::Running {
            let taken = receiver.on_bytes(now_ms, &to_host);
            to_host.drain(..taken);
            let length = receiver.poll(now_ms, &mut frame);
            assert_eq!(sender.on_bytes(now_ms, &frame[..length]), length);
        }
    }
    assert_eq!(receiver.state(), State::Done);
    let text = to_host.rsplit(|&byte| byte == 0).next();
    assert_eq!(text, Some(&b"ok\r\n"[..]));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_bytes_upset_either_side(chunks in proptest::collection::vec((any::<u16>(), proptest::collection::vec(any::<u8>(), 0..300)), 0..40)) {
        let data = some_data(3_000);
        let mut buffer = [0; 1_000];
        let mut sender = Sender::new(&data, 0, Timing::HOST, 0);
        let mut receiver = Receiver::new(&mut buffer, None, Timing::CONSOLE, 0);
        let mut frame = [0; MAX_FRAME];
        let mut now_ms = 0;
        for (wait, bytes) in chunks {
            now_ms += u64::from(wait >> 6);
            sender.on_bytes(now_ms, &bytes);
            receiver.on_bytes(now_ms, &bytes);
            let length = sender.poll(now_ms, &mut frame);
            receiver.on_bytes(now_ms, &frame[..length]);
            receiver.poll(now_ms, &mut frame);
        }
        prop_assert_eq!(receiver.received(), None);
    }
}
