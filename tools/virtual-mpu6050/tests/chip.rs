//! Tests of the virtual MPU-6050 against the data sheet and the register map.

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::{I2c, NoAcknowledgeSource};
use virtual_mpu6050::{
    ADDRESS, Bus, Chip, Counts, Error, Fault, Imperfections, RESET_TIME, Source, State,
};

const MILLISECOND: u64 = 1_000_000;

fn bus_of(motion: impl Fn(f64) -> State + Send + 'static, imperfections: Imperfections) -> Bus {
    Bus::new(Chip::new(
        Source::Motion(Box::new(motion)),
        imperfections,
        1,
    ))
}

fn still() -> Bus {
    bus_of(|_| State::default(), Imperfections::NONE)
}

fn read(bus: &mut Bus, register: u8) -> u8 {
    let mut byte = [0];
    bus.write_read(ADDRESS, &[register], &mut byte)
        .expect("an answer");
    byte[0]
}

fn write(bus: &mut Bus, register: u8, value: u8) {
    bus.write(ADDRESS, &[register, value])
        .expect("an acknowledge");
}

/// Wakes the chip and configures it: samples at 1 kHz, the 98 Hz filter, ranges of ±2000 °/s and ±8 g, and reporting of new data in
/// INT_STATUS.
fn wake(bus: &mut Bus) {
    for (register, value) in [(0x6b, 1), (0x1a, 2), (0x1b, 0x18), (0x1c, 0x10), (0x38, 1)] {
        write(bus, register, value);
    }
}

/// Reads INT_STATUS and the data registers in one burst. Returns whether the data are new, and the counts.
fn burst(bus: &mut Bus) -> (bool, Counts) {
    let mut bytes = [0; 15];
    bus.write_read(ADDRESS, &[0x3a], &mut bytes)
        .expect("an answer");
    let count = |at: usize| i16::from_be_bytes([bytes[at], bytes[at + 1]]);
    let counts = Counts {
        accel: [1, 3, 5].map(count),
        temperature: count(7),
        gyro: [9, 11, 13].map(count),
    };
    (bytes[0] & 1 != 0, counts)
}

#[test]
fn it_wakes_up_as_in_the_register_map() {
    let mut bus = still();
    assert_eq!((read(&mut bus, 0x75), read(&mut bus, 0x6b)), (0x68, 0x40));
    bus.delay_ms(20);
    assert!(!burst(&mut bus).0, "a sleeping chip measures nothing");
    wake(&mut bus);
    bus.delay_ms(2);
    let (fresh, counts) = burst(&mut bus);
    assert!(fresh);
    // 25 °C is −3920 counts, and 1 g is 4096 counts.
    assert_eq!(counts.accel, [0, 0, 4096]);
    assert_eq!(counts.temperature, -3920);
    assert!(!burst(&mut bus).0, "reading clears the status");
    // A reset takes time and ends in sleep mode.
    write(&mut bus, 0x6b, 0x80);
    let error = bus.write(ADDRESS, &[0x6b, 1]).expect_err("no answer");
    assert_eq!(error, Error::NoAcknowledge(NoAcknowledgeSource::Address));
    bus.advance(RESET_TIME);
    assert_eq!((read(&mut bus, 0x6b), read(&mut bus, 0x1b)), (0x40, 0));
}

#[test]
fn rates_and_ranges_follow_the_registers() {
    let rate = |_| State {
        rate: [100.0, -100.0, 1990.0],
        ..State::default()
    };
    let mut bus = bus_of(rate, Imperfections::NONE);
    wake(&mut bus);
    let cases = [
        (0x00, 13_100, i16::MAX),
        (0x08, 6_550, i16::MAX),
        (0x18, 1_640, 32_636),
    ];
    for (range, x, z) in cases {
        write(&mut bus, 0x1b, range);
        bus.delay_ms(2);
        let (_, counts) = burst(&mut bus);
        assert_eq!(counts.gyro, [x, -x, z], "range {range:#x}");
    }
    for (filter, divider, period) in [
        (0, 0, 125_000),
        (0, 7, MILLISECOND),
        (2, 0, MILLISECOND),
        (2, 4, 5 * MILLISECOND),
    ] {
        write(&mut bus, 0x1a, filter);
        write(&mut bus, 0x19, divider);
        bus.delay_ms(10);
        let before = bus.with_chip(|chip| chip.samples);
        bus.delay_ms(100);
        let samples = bus.with_chip(|chip| chip.samples) - before;
        assert_eq!(samples, 100 * MILLISECOND / period);
    }
}

#[test]
fn the_filter_delays() {
    let step = |time| State {
        rate: [if time < 0.1 { 0.0 } else { 500.0 }, 0.0, 0.0],
        ..State::default()
    };
    for (filter, delay) in [(1, 1_900_000), (2, 2_800_000), (6, 18_600_000)] {
        let mut bus = bus_of(step, Imperfections::NONE);
        wake(&mut bus);
        write(&mut bus, 0x1a, filter);
        while burst(&mut bus).1.gyro[0] == 0 {
            assert!(bus.now() < 200 * MILLISECOND);
        }
        let late = bus.now() - 100 * MILLISECOND;
        assert!((delay..delay + 2 * MILLISECOND).contains(&late), "{late}");
    }
}

#[test]
fn errors_match_the_imperfections() {
    let motion = |time: f64| State {
        rate: [200.0, 0.0, 0.0],
        temperature: if time < 20.0 { 25.0 } else { 45.0 },
        ..State::default()
    };
    let imperfections = Imperfections {
        bias: [0.0, 4.5, 0.0],
        drift: [0.0, 0.0, 0.1],
        scale: [1.03, 1.0, 1.0],
        noise: 0.005,
        clock: 0.01,
        ..Imperfections::NONE
    };
    let mut bus = bus_of(motion, imperfections);
    wake(&mut bus);
    let mean = |bus: &mut Bus| {
        // Skips the current sample, because the chip may have measured it before it was configured.
        bus.delay_ms(2);
        burst(bus);
        let (mut sum, mut squares, mut count) = ([0.0; 3], 0.0, 0.0);
        let end = bus.now() + 2_000 * MILLISECOND;
        while bus.now() < end {
            let (fresh, counts) = burst(bus);
            if fresh {
                count += 1.0;
                let rate = counts.gyro.map(|x| f64::from(x) / 16.4);
                squares += (rate[1] - 4.5).powi(2);
                sum = [0, 1, 2].map(|i| sum[i] + rate[i]);
            }
        }
        (sum.map(|x| x / count), (squares / count).sqrt(), count)
    };
    let (rates, deviation, count) = mean(&mut bus);
    for (rate, expected) in rates.into_iter().zip([206.0, 4.5, 0.0]) {
        assert!((rate - expected).abs() < 0.02, "{rates:?}");
    }
    // Expected deviation: noise of 0.005 °/s per √Hz in a bandwidth of 98 Hz, and the rounding to counts.
    assert!((0.055..0.075).contains(&deviation), "{deviation}");
    assert!((2018.0..2022.0).contains(&count), "{count}");
    bus.advance(20_000 * MILLISECOND);
    let (rates, ..) = mean(&mut bus);
    assert!((rates[2] - 2.0).abs() < 0.02, "{rates:?}");
}

#[test]
fn a_burst_is_one_sample_and_single_bytes_need_not_be() {
    let ramp = |time: f64| State {
        rate: [time * 10_000.0; 3],
        ..State::default()
    };
    let mut bus = bus_of(ramp, Imperfections::NONE);
    wake(&mut bus);
    let mut torn = 0;
    for _ in 0..100 {
        let [x, y, z] = burst(&mut bus).1.gyro;
        assert!(x == y && y == z);
        let single = [0x43, 0x45, 0x47].map(|register| read(&mut bus, register));
        torn += u32::from(single[0] != single[2]);
    }
    assert!(torn > 0);
}

#[test]
fn a_log_is_played_unchanged() {
    let sample = |x| Counts {
        gyro: [x, 0, 0],
        ..Counts::default()
    };
    let log = vec![(0, sample(1)), (50 * MILLISECOND, sample(-32_768))];
    let mut bus = Bus::new(Chip::new(Source::Log(log), Imperfections::TYPICAL, 1));
    wake(&mut bus);
    bus.delay_ms(10);
    assert_eq!(burst(&mut bus).1, sample(1));
    bus.delay_ms(60);
    assert_eq!(burst(&mut bus).1, sample(-32_768));
}

#[test]
fn faults_show_on_the_bus() {
    let turning = |time: f64| State {
        rate: [100.0 * time, 0.0, 0.0],
        ..State::default()
    };
    let mut bus = bus_of(turning, Imperfections::NONE);
    wake(&mut bus);
    let mut with = |fault| {
        bus.with_chip(|chip| chip.fault = Some(fault));
        bus.delay_ms(5);
        let before = bus.now();
        let mut bytes = [0; 15];
        let result = bus.write_read(ADDRESS, &[0x3a], &mut bytes);
        let first = (result, bytes, bus.now() - before);
        bus.delay_ms(5);
        let mut later = [0; 15];
        let _ = bus.write_read(ADDRESS, &[0x3a], &mut later);
        (first, later)
    };
    let ((absent, ..), _) = with(Fault::Absent);
    assert_eq!(
        absent,
        Err(Error::NoAcknowledge(NoAcknowledgeSource::Address))
    );
    let ((refused, ..), _) = with(Fault::NoAcknowledge);
    assert_eq!(
        refused,
        Err(Error::NoAcknowledge(NoAcknowledgeSource::Data))
    );
    let ((stuck, ..), _) = with(Fault::StuckData(0));
    assert_eq!(stuck, Err(Error::Stuck));
    let ((freed, ..), _) = with(Fault::StuckData(9));
    assert_eq!(freed, Ok(()));
    let ((slow, _, took), _) = with(Fault::Stretched(100_000));
    assert_eq!(slow, Ok(()));
    assert!(took > 18 * 100_000, "{took}");
    let ((held, ..), _) = with(Fault::Stretched(u64::MAX));
    assert_eq!(held, Err(Error::Stuck));
    let ((result, frozen, _), later) = with(Fault::Frozen);
    assert_eq!((result, frozen[0], frozen), (Ok(()), 1, later));
    let ((result, _, _), later) = with(Fault::Stalled);
    assert_eq!((result, later[0]), (Ok(()), 0));
    bus.with_chip(|chip| chip.fault = Some(Fault::Identity(0x70)));
    assert_eq!(read(&mut bus, 0x75), 0x70);
}
