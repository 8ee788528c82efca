//! The live page of a board on a serial port: its console, and pictures on request.

use crate::board::{Board, SerialBoard};
use glint_live_page::Live;
use std::time::Duration;

impl Live for SerialBoard {
    fn sample_period(&self) -> Duration {
        Duration::from_secs(2)
    }

    fn clock(&self) -> Duration {
        Duration::from_millis(self.now_ms())
    }
}
