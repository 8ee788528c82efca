//! The serial line, shared by its interrupt and the program.

use glint_hal::uart::{Uart, Writer};

/// Capacity of the receive queue in bytes: enough for more than a second of input at 115,200 baud, and for several windows
/// of an upload.
const RECEIVE_QUEUE: usize = 16 << 10;
/// Capacity of the send queue in bytes.
const SEND_QUEUE: usize = 4 << 10;

/// The type of the SoC's UART, with the capacities of its queues.
pub type ConsoleUart = Uart<RECEIVE_QUEUE, SEND_QUEUE>;

/// The type of a writer to the UART's send queue.
pub type ConsoleWriter = Writer<'static, RECEIVE_QUEUE, SEND_QUEUE>;

/// The UART, shared by its interrupt and the program.
pub static UART: ConsoleUart = ConsoleUart::new();
