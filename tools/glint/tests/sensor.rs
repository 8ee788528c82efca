//! A board's sensor over its console.

use glint::board::{SimulatedBoard, built_firmware};
use glint::console::Console;
use glint::imu::log::Entry;
use glint::imu::sensor;

/// The board's time after which a silent firmware has failed.
const PATIENCE_MS: u64 = 2_000;

#[test]
fn a_sensor_is_found_calibrated_and_gives_samples() {
    let firmware = built_firmware(None).unwrap();
    let mut board = SimulatedBoard::fast(&firmware).unwrap();
    board.inner().plug(sensor::virtual_sensor(None));
    let mut console = Console::new(&mut board).patience(PATIENCE_MS);
    console.greet().unwrap();
    assert_eq!(sensor::wait(&mut console).unwrap(), "MPU-6050");

    let found = sensor::calibrate(&mut console, 64, &mut |_| {}).unwrap();
    assert_eq!(found.samples, 64);
    // Those of the specimen, as near as the noise of 64 samples lets them be.
    for (found, bias) in found.bias.iter().zip([-4.5, 1.25, 2.0]) {
        assert!((found - bias).abs() < 0.1, "{found}, expected {bias}");
    }

    let mut entries: Vec<Entry> = Vec::new();
    sensor::stream(&mut console, 10, &mut |entry| entries.push(entry)).unwrap();
    assert_eq!(entries.len(), 10);
    assert_eq!(entries[0].t_us, 0);
    for pair in entries.windows(2) {
        // None is told twice; some may have come while one was told.
        let step = pair[1].t_us - pair[0].t_us;
        let samples = (step + 500) / 1_000;
        assert!(
            samples >= 1 && step.abs_diff(samples * 1_000) < 100,
            "{step}"
        );
    }
    // Gravity, with the specimen's scale and bias.
    assert!(
        entries
            .iter()
            .all(|entry| (4_150..4_350).contains(&entry.accel[2]))
    );
}
