//! An emulated board in its BIOS with its serial line and its switches, as WebAssembly: the board at the other end of a port in tests of the page
//! (`tools/glint/tests/page/pipe.js`).

use emulated_board::EmulatedBoard;
use glint_board_api::{Simulation, Uart};
use std::cell::RefCell;

/// The board, and the bytes to and from it.
struct Pipe {
    board: Option<EmulatedBoard>,
    bytes: Vec<u8>,
}

thread_local! {
    static PIPE: RefCell<Pipe> = const { RefCell::new(Pipe { board: None, bytes: Vec::new() }) };
}

/// Resizes the buffer to `length` bytes, and returns its address, where the caller writes the bytes before the next call.
#[unsafe(no_mangle)]
pub extern "C" fn buffer(length: usize) -> *mut u8 {
    PIPE.with_borrow_mut(|Pipe { bytes, .. }| {
        bytes.clear();
        bytes.resize(length, 0);
        bytes.as_mut_ptr()
    })
}

/// Starts the board with the BIOS in the buffer.
#[unsafe(no_mangle)]
pub extern "C" fn start() {
    PIPE.with_borrow_mut(|Pipe { board, bytes }| *board = Some(EmulatedBoard::full(bytes)));
}

/// Sends the bytes in the buffer to the board.
#[unsafe(no_mangle)]
pub extern "C" fn send() {
    PIPE.with_borrow_mut(|Pipe { board, bytes }| {
        board.iter_mut().for_each(|board| board.uart_write(bytes));
    });
}

/// Sets the 16 switches, one bit each.
#[unsafe(no_mangle)]
pub extern "C" fn set_switches(on: u32) {
    PIPE.with_borrow_mut(|Pipe { board, .. }| {
        board
            .iter_mut()
            .for_each(|board| board.set_switches(on as u16));
    });
}

/// Runs the board for a number of milliseconds of its time. Then the buffer has the bytes that the board has sent; returns their number.
#[unsafe(no_mangle)]
pub extern "C" fn run(milliseconds: f64) -> usize {
    PIPE.with_borrow_mut(|Pipe { board, bytes }| {
        bytes.clear();
        if let Some(board) = board {
            board.run((f64::from(board.clock_hz()) / 1000.0 * milliseconds) as u64);
            board.uart_read(bytes);
        }
        bytes.len()
    })
}

/// Address of the bytes in the buffer.
#[unsafe(no_mangle)]
pub extern "C" fn output() -> *const u8 {
    PIPE.with_borrow(|pipe| pipe.bytes.as_ptr())
}
