//! The virtual board as one of the simulated boards.

use glint_board_api::{BoardError, Frame, Simulation, Uart, own_pins, own_uart};

use crate::VirtualBoard;

impl Uart for VirtualBoard {
    own_uart!();
}

impl Simulation for VirtualBoard {
    own_pins!();

    fn read_memory(&mut self, address: u32, bytes: &mut [u8]) -> Result<(), BoardError> {
        self.ddr_read(address, bytes)
            .map_err(BoardError::simulation)
    }

    fn write_memory(&mut self, address: u32, bytes: &[u8]) -> Result<(), BoardError> {
        self.ddr_write(address, bytes)
            .map_err(BoardError::simulation)
    }

    fn new_frame(&mut self, last: u64) -> Result<Option<(u64, Frame)>, BoardError> {
        self.monitor().turn_on();
        let Some(picture) = self.monitor().take_picture() else {
            return Ok(None);
        };
        // If larger blocks have equal pixels, the frame is smaller.
        let mut scales = [4, 2].into_iter();
        let smaller = scales.find_map(|scale| Some((scale, picture.scaled_back(scale).ok()?)));
        let (scale, pixels) = match smaller {
            Some(found) => found,
            None => (1, picture.scaled_back(1).map_err(BoardError::simulation)?),
        };
        let frame = Frame {
            width: picture.width() / scale,
            height: picture.height() / scale,
            pixels,
        };
        Ok(Some((last + 1, frame)))
    }

    fn monitor_frame(&mut self, scale: usize) -> Result<Vec<u16>, BoardError> {
        let picture = self.capture().map_err(BoardError::simulation)?;
        picture.scaled_back(scale).map_err(BoardError::simulation)
    }
}
