//! The sensor of a board, accessed through the board's console.

use crate::common::{console, emulator};
use glint::board::Simulation;
use glint::imu::log::Entry;
use glint::imu::sensor;

#[test]
fn a_sensor_is_found_calibrated_and_gives_samples() {
    let mut board = emulator();
    board.inner().plug(sensor::virtual_sensor(None));
    let mut console = console(&mut board);
    assert_eq!(sensor::wait(&mut console).unwrap(), "MPU-6050");

    let found = sensor::calibrate(&mut console, 64, &mut |_| {}).unwrap();
    assert_eq!(found.samples, 64);
    // The measured biases equal the virtual sensor's, within the noise of 64 samples.
    for (found, bias) in found.bias.iter().zip([-4.5, 1.25, 2.0]) {
        assert!((found - bias).abs() < 0.1, "{found}, expected {bias}");
    }

    let mut entries: Vec<Entry> = Vec::new();
    sensor::stream(&mut console, 10, &mut |entry| entries.push(entry)).unwrap();
    assert_eq!(entries.len(), 10);
    assert_eq!(entries[0].t_us, 0);
    for pair in entries.windows(2) {
        // The board prints no sample twice, and skips samples that arrive while it prints a sample.
        let step = pair[1].t_us - pair[0].t_us;
        let samples = (step + 500) / 1_000;
        assert!(
            samples >= 1 && step.abs_diff(samples * 1_000) < 100,
            "{step}"
        );
    }
    // The acceleration along z is gravity (4096 counts), changed by the virtual sensor's scale error and bias.
    assert!(
        entries
            .iter()
            .all(|entry| (4_150..4_350).contains(&entry.accel[2]))
    );
}
