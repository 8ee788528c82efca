//! Implements the interfaces of simulated boards for the emulated board.

use glint_board_api::{BoardError, Frame, Simulation, Uart, own_pins, own_uart};
use litex_pac::scanout::Scanout;

use crate::{EmulatedBoard, Error};

impl Uart for EmulatedBoard {
    own_uart!();
}

impl Simulation for EmulatedBoard {
    own_pins!();

    fn read_memory(&mut self, address: u32, bytes: &mut [u8]) -> Result<(), BoardError> {
        EmulatedBoard::read_memory(self, address, bytes).map_err(BoardError::simulation)
    }

    fn write_memory(&mut self, address: u32, bytes: &[u8]) -> Result<(), BoardError> {
        self.write_memory(address, bytes)
            .map_err(BoardError::simulation)
    }

    fn new_frame(&mut self, last: u64) -> Result<Option<(u64, Frame)>, BoardError> {
        let number = self.blankings();
        Ok((number != last).then(|| (number, self.shown())))
    }

    fn monitor_frame(&mut self, scale: usize) -> Result<Vec<u16>, BoardError> {
        let frame = self.capture();
        let (expected, found) = (Scanout::SCREEN_WIDTH as usize / scale.max(1), frame.width);
        if found != expected {
            let error = Error::FrameWidth { expected, found };
            return Err(BoardError::simulation(error));
        }
        Ok(frame.pixels)
    }
}
