//! The live page of a board on a serial port.

use crate::board::{Board, BoardError, MonitorFrame, SerialBoard};
use glint_live_page::Live;
use glint_live_page::inputs::Levels;
use glint_live_page::message::Pins;
use glint_live_page::motion::Motion;
use std::sync::Arc;
use std::time::Duration;

/// A board on a serial port, with its console and with pictures on request.
pub struct LiveSerial(pub SerialBoard);

impl Board for LiveSerial {
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        self.0.write(bytes)
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        self.0.read(bytes, wait_ms)
    }

    fn now_ms(&self) -> u64 {
        self.0.now_ms()
    }
}

impl Live for LiveSerial {
    fn motion(&self) -> Option<Arc<Motion>> {
        None
    }

    fn pins(&mut self, _levels: Levels) -> Option<Pins> {
        None
    }

    fn picture(&mut self) -> Result<Option<MonitorFrame>, BoardError> {
        Ok(None)
    }

    fn sample_period(&self) -> Duration {
        Duration::from_secs(2)
    }

    fn clock(&self) -> Duration {
        Duration::from_millis(self.0.now_ms())
    }
}
