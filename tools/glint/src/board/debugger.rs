//! An emulated board under the control of GDB, by GDB's remote serial protocol over TCP.
//!
//! A debugger that connects stops the board. The board runs again when the debugger sends `continue`, detaches or ends. The time of a
//! stopped board does not advance. One debugger at a time can be connected.

use std::convert::Infallible;
use std::io;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::thread::sleep;
use std::time::Duration;

use emulated_board::EmulatedBoard;
use gdbstub::common::Signal;
use gdbstub::conn::ConnectionExt;
use gdbstub::stub::state_machine::GdbStubStateMachine;
use gdbstub::stub::{GdbStub, GdbStubError, SingleThreadStopReason};
use gdbstub::target::ext::base::BaseOps;
use gdbstub::target::ext::base::singlethread::{
    SingleThreadBase, SingleThreadResume, SingleThreadResumeOps, SingleThreadSingleStep,
    SingleThreadSingleStepOps,
};
use gdbstub::target::ext::breakpoints::{
    Breakpoints, BreakpointsOps, SwBreakpoint, SwBreakpointOps,
};
use gdbstub::target::{Target, TargetError, TargetResult};
use gdbstub_arch::riscv::Riscv32;
use gdbstub_arch::riscv::reg::RiscvCoreRegs;
use glint_board_api::{BoardError, Frame, Simulation, Uart};
use virtual_board::virtual_flash::Flash;
use virtual_board::virtual_image_sensor::ImageSensor;
use virtual_board::virtual_mpu6050::Wires;

/// Number of the board's cycles between two polls for a new debugger, or for Ctrl-C from a connected debugger: 1 ms at 81.25 MHz.
const POLL: u64 = 81_250;

/// Time between two polls for the next packet while the board is stopped.
const PAUSE: Duration = Duration::from_millis(1);

/// Time-out of writing a reply, for a debugger that does not read; after this time the connection is closed.
const PATIENCE: Duration = Duration::from_secs(1);

/// Maximum number of bytes to handle in one call of [`Uart::run`], so that a debugger that sends without end does not block this
/// program.
const STEPS: usize = 1 << 16;

/// The state of a connection to a debugger.
type Connection = GdbStubStateMachine<'static, Debugged, TcpStream>;

/// An emulated board that a debugger may control.
pub struct DebuggedBoard {
    board: Debugged,
    listener: TcpListener,
    connection: Option<Connection>,
    /// The board's cycle of the next poll for a debugger while the board runs.
    next_poll: u64,
}

impl DebuggedBoard {
    /// Listens for a debugger of `board` at `address`; port 0 selects a free port.
    ///
    /// # Errors
    /// The address cannot be used.
    pub fn new(board: EmulatedBoard, address: SocketAddr) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        Ok(Self {
            board: Debugged {
                board,
                steps: false,
            },
            listener,
            connection: None,
            next_poll: 0,
        })
    }

    /// The address at which a debugger connects.
    ///
    /// # Errors
    /// The system does not report the address.
    pub fn address(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }

    /// Handles the bytes that a debugger has sent. Returns whether the board runs.
    fn serve(&mut self) -> bool {
        if self.connection.is_none()
            && let Ok((stream, _)) = self.listener.accept()
            && stream.set_write_timeout(Some(PATIENCE)).is_ok()
        {
            self.board.steps = false;
            let connection = GdbStub::new(stream).run_state_machine(&mut self.board);
            self.connection = connection.ok();
        }
        for _ in 0..STEPS {
            let Some(connection) = self.connection.take() else {
                break;
            };
            match advance(connection, &mut self.board) {
                // The debugger has disconnected, or has violated the protocol: the board runs without it.
                Err(_) | Ok(Advanced::Ended) => {
                    let board = &mut self.board.board;
                    for address in board.breakpoints().to_vec() {
                        board.remove_breakpoint(address);
                    }
                }
                Ok(Advanced::Further(connection)) => self.connection = Some(connection),
                Ok(Advanced::Waits(connection)) => {
                    self.connection = Some(connection);
                    break;
                }
            }
        }
        matches!(self.connection, None | Some(Connection::Running(_)))
    }

    /// Reports to the debugger why the board has stopped.
    fn report(&mut self, reason: SingleThreadStopReason<u32>) {
        self.connection = match self.connection.take() {
            Some(Connection::Running(running)) => running.report_stop(&mut self.board, reason).ok(),
            other => other,
        };
        // The debugger's answer decides whether the board runs or steps, so the next run polls at once.
        self.next_poll = self.cycles();
    }
}

/// A connection after [`advance`].
enum Advanced {
    /// More bytes may have arrived.
    Further(Connection),
    /// No byte has arrived.
    Waits(Connection),
    /// The debugger has detached.
    Ended,
}

/// Handles one byte from the debugger, if any has arrived.
fn advance(
    connection: Connection,
    board: &mut Debugged,
) -> Result<Advanced, GdbStubError<Infallible, io::Error>> {
    /// The next byte in `stream`, if any.
    fn byte(stream: &mut TcpStream) -> io::Result<Option<u8>> {
        // At the end of the stream, `peek` returns a byte, and `read` then fails.
        match ConnectionExt::peek(stream)? {
            Some(_) => ConnectionExt::read(stream).map(Some),
            None => Ok(None),
        }
    }
    Ok(match connection {
        Connection::Idle(mut idle) => match byte(idle.borrow_conn()) {
            Ok(Some(byte)) => Advanced::Further(idle.incoming_data(board, byte)?),
            Ok(None) => Advanced::Waits(idle.into()),
            Err(_) => Advanced::Ended,
        },
        Connection::Running(mut running) => match byte(running.borrow_conn()) {
            Ok(Some(byte)) => Advanced::Further(running.incoming_data(board, byte)?),
            Ok(None) => Advanced::Waits(running.into()),
            Err(_) => Advanced::Ended,
        },
        Connection::CtrlCInterrupt(interrupt) => {
            let reason = SingleThreadStopReason::Signal(Signal::SIGINT);
            Advanced::Further(interrupt.interrupt_handled(board, Some(reason))?)
        }
        Connection::Disconnected(_) => Advanced::Ended,
    })
}

impl Uart for DebuggedBoard {
    /// Runs the board. While a debugger has stopped the board, waits for at most a millisecond instead.
    fn run(&mut self, cycles: u64) {
        let is_stopped = matches!(self.connection, Some(Connection::Idle(_)));
        if is_stopped || self.cycles() >= self.next_poll {
            let runs = self.serve();
            self.next_poll = self.cycles() + POLL;
            if !runs {
                sleep(PAUSE);
                return;
            }
        }
        if std::mem::take(&mut self.board.steps) {
            self.board.board.step();
            return self.report(SingleThreadStopReason::DoneStep);
        }
        self.board.board.run(cycles);
        if self.board.board.is_at_breakpoint() {
            self.report(SingleThreadStopReason::SwBreak(()));
        }
    }

    fn cycles(&self) -> u64 {
        self.board.board.cycles()
    }

    fn clock_hz(&self) -> u32 {
        self.board.board.clock_hz()
    }

    fn uart_write(&mut self, bytes: &[u8]) {
        self.board.board.uart_write(bytes);
    }

    fn uart_queued(&self) -> usize {
        self.board.board.uart_queued()
    }

    fn uart_output(&mut self) -> &mut Vec<u8> {
        self.board.board.uart_output()
    }
}

impl Simulation for DebuggedBoard {
    fn read_memory(&mut self, address: u32, bytes: &mut [u8]) -> Result<(), BoardError> {
        self.board.board.read_memory(address, bytes)
    }

    fn write_memory(&mut self, address: u32, bytes: &[u8]) -> Result<(), BoardError> {
        self.board.board.write_memory(address, bytes)
    }

    fn boot(&mut self, program: &[u8]) -> Result<(), BoardError> {
        self.board.board.boot(program)
    }

    fn plug(&mut self, sensor: Wires) {
        self.board.board.plug(sensor);
    }

    fn plug_flash(&mut self, flash: Flash) {
        self.board.board.plug_flash(flash);
    }

    fn plug_image_sensor(&mut self, sensor: ImageSensor) {
        self.board.board.plug_image_sensor(sensor);
    }

    fn digits(&self) -> [u8; 8] {
        self.board.board.digits()
    }

    fn set_buttons(&mut self, pressed: u8) {
        self.board.board.set_buttons(pressed);
    }

    fn set_switches(&mut self, on: u16) {
        self.board.board.set_switches(on);
    }

    fn leds(&self) -> u16 {
        self.board.board.leds()
    }

    fn new_frame(&mut self, last: u64) -> Result<Option<(u64, Frame)>, BoardError> {
        self.board.board.new_frame(last)
    }

    fn monitor_frame(&mut self, scale: usize) -> Result<Vec<u16>, BoardError> {
        self.board.board.monitor_frame(scale)
    }
}

/// The emulated board as the debugger sees it: a processor and its memories.
struct Debugged {
    board: EmulatedBoard,
    /// Whether the board executes one instruction and then stops.
    steps: bool,
}

impl Target for Debugged {
    type Arch = Riscv32;
    type Error = Infallible;

    fn base_ops(&mut self) -> BaseOps<'_, Riscv32, Infallible> {
        BaseOps::SingleThread(self)
    }

    fn support_breakpoints(&mut self) -> Option<BreakpointsOps<'_, Self>> {
        Some(self)
    }
}

impl SingleThreadBase for Debugged {
    fn read_registers(&mut self, registers: &mut RiscvCoreRegs<u32>) -> TargetResult<(), Self> {
        (registers.x, registers.pc) = (self.board.registers(), self.board.pc());
        Ok(())
    }

    fn write_registers(&mut self, registers: &RiscvCoreRegs<u32>) -> TargetResult<(), Self> {
        self.board.set_registers(&registers.x);
        if registers.pc != self.board.pc() {
            self.board.set_pc(registers.pc);
        }
        Ok(())
    }

    fn read_addrs(&mut self, start: u32, bytes: &mut [u8]) -> TargetResult<usize, Self> {
        match self.board.peek(start, bytes) {
            0 => Err(TargetError::NonFatal),
            count => Ok(count),
        }
    }

    fn write_addrs(&mut self, start: u32, bytes: &[u8]) -> TargetResult<(), Self> {
        let is_written = self.board.poke(start, bytes);
        is_written.then_some(()).ok_or(TargetError::NonFatal)
    }

    fn support_resume(&mut self) -> Option<SingleThreadResumeOps<'_, Self>> {
        Some(self)
    }
}

impl SingleThreadResume for Debugged {
    fn resume(&mut self, _: Option<Signal>) -> Result<(), Infallible> {
        self.steps = false;
        Ok(())
    }

    fn support_single_step(&mut self) -> Option<SingleThreadSingleStepOps<'_, Self>> {
        Some(self)
    }
}

impl SingleThreadSingleStep for Debugged {
    fn step(&mut self, _: Option<Signal>) -> Result<(), Infallible> {
        self.steps = true;
        Ok(())
    }
}

impl Breakpoints for Debugged {
    fn support_sw_breakpoint(&mut self) -> Option<SwBreakpointOps<'_, Self>> {
        Some(self)
    }
}

impl SwBreakpoint for Debugged {
    fn add_sw_breakpoint(&mut self, address: u32, _: usize) -> TargetResult<bool, Self> {
        self.board.add_breakpoint(address);
        Ok(true)
    }

    fn remove_sw_breakpoint(&mut self, address: u32, _: usize) -> TargetResult<bool, Self> {
        Ok(self.board.remove_breakpoint(address))
    }
}
