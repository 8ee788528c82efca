//! Self-tests of the machine.

use glint_core::mpu6050::Error;
use glint_hal::i2c;
use litex_pac::cpu;

use crate::machine::Machine;

/// Number of bytes in the memory test: four times the size of the data cache.
const TESTED: usize = 16 << 10;

/// Runs all tests and returns the name of each test and whether it passed.
pub fn run(machine: &mut Machine) -> [(&'static str, bool); 6] {
    let memory = memory(machine.models.staging());
    [
        ("identity", machine.identity.matches()),
        ("clock", machine.clock.cycles() < machine.clock.cycles()),
        ("cycle counter", cpu::cycles_low() != cpu::cycles_low()),
        ("memory", memory),
        ("scan-out", machine.renderer.display.is_visible()),
        ("i2c", !is_stuck(machine)),
    ]
}

/// Whether a wire of the sensor's bus is stuck low.
fn is_stuck(machine: &Machine) -> bool {
    matches!(
        machine.imu.error(),
        Some(Error::Bus(
            i2c::BusError::ClockStuck | i2c::BusError::DataStuck
        ))
    )
}

/// Tests the start of `window`, a part of main memory: writes a different word to each address, flushes the cache, and
/// returns whether all words read back right.
fn memory(window: &mut [u8]) -> bool {
    let (words, _) = window
        .get_mut(..TESTED)
        .unwrap_or_default()
        .as_chunks_mut::<4>();
    let pattern = |index: usize| (index as u32).wrapping_mul(0x9e37_79b9).to_le_bytes();
    for (index, word) in words.iter_mut().enumerate() {
        *word = pattern(index);
    }
    cpu::flush_data_cache();
    !words.is_empty()
        && words
            .iter()
            .enumerate()
            .all(|(index, word)| *word == pattern(index))
}
