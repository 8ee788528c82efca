//! The emulated board: CPU, bus, devices, and the sensors, buttons and switches at its pins.

use glint_board_api::{BoardError, Frame, Simulation, Uart};
use glint_core::colour::Shading;
use litex_pac::constants::CONFIG_CLOCK_FREQUENCY;
use litex_pac::memories::MAIN_RAM;
use litex_pac::scanout::Scanout;
use virtual_flash::Flash;
use virtual_image_sensor::ImageSensor;
use virtual_mpu6050::Wires;

use crate::bus::Bus;
use crate::cpu::{Cpu, Difference, Executed, Pause};
use crate::devices::Devices;
use crate::error::Error;

/// In lockstep with another board, factor by which the devices' time runs faster than the time of
/// the other board. With this factor, an engine ends before the program starts it again, even if the estimate of its time is
/// too long.
const FOLLOWING: u64 = 16;

/// An emulated board.
pub struct EmulatedBoard {
    pub(crate) cpu: Cpu,
    pub(crate) bus: Bus,
    cycles: u64,
    /// Whether the last run ended at a breakpoint.
    pub(crate) is_at_breakpoint: bool,
}

impl EmulatedBoard {
    /// A board in the state after the BIOS has run: `firmware` is at the start of main memory,
    /// where the CPU starts.
    ///
    /// # Errors
    /// [`Error::Address`] for firmware that exceeds main memory.
    pub fn fast(firmware: &[u8]) -> Result<Self, Error> {
        let mut board = Self::full(&jump(MAIN_RAM.base));
        let place = board.memory(MAIN_RAM.base, firmware.len())?;
        place.copy_from_slice(firmware);
        Ok(board)
    }

    /// A board whose CPU starts in the ROM with the content `rom`; bytes beyond the ROM's size are ignored.
    #[must_use]
    pub fn full(rom: &[u8]) -> Self {
        let mut bus = Bus::new(Devices::new());
        bus.set_rom(rom);
        Self {
            cpu: Cpu::new(),
            bus,
            cycles: 0,
            is_at_breakpoint: false,
        }
    }

    /// Executes the next instruction, and compares its address and result with the instruction `other` of another board's CPU.
    ///
    /// Takes an interrupt where the other CPU took one. Results that depend on time are copied from the other CPU: loads from registers of
    /// devices, and reads of counters and of pending interrupts. As on every emulated board, an engine does its whole work when the program
    /// starts it.
    ///
    /// # Errors
    /// The CPUs execute different instructions, or leave different values in a register.
    pub fn follow(&mut self, other: Executed) -> Result<(), Difference> {
        let now = other.cycle * FOLLOWING;
        self.bus.devices.advance(now, &mut self.bus.ram);
        self.cpu.follow(&mut self.bus, now, other)
    }

    /// Number of executed instructions since the start.
    #[must_use]
    pub fn instructions(&self) -> u64 {
        self.cpu.retired()
    }

    /// The sensor on the I2C bus, if any.
    pub fn sensor(&mut self) -> Option<&mut Wires> {
        self.bus.devices.i2c.sensor.as_mut()
    }

    /// Disconnects the sensor from the I2C bus, and returns it.
    pub fn unplug(&mut self) -> Option<Wires> {
        self.bus.devices.i2c.sensor.take()
    }

    /// Sets the block enable bits of the gateware's identity, to emulate a gateware without some blocks. The blocks still work.
    pub fn state_blocks(&mut self, blocks: u32) {
        self.bus.devices.identity.blocks = blocks;
    }

    /// Sets whether the triangle engine draws textures. The firmware reads this setting when the firmware starts.
    pub fn state_textures(&mut self, is_textured: bool) {
        self.bus.devices.triangle.set_textures(is_textured);
    }

    /// Sets the best shading of the triangle engine, to emulate a gateware without smooth shading. The firmware reads this setting when the
    /// firmware starts.
    pub fn state_shading(&mut self, capability: Shading) {
        self.bus.devices.triangle.set_shading(capability);
    }

    /// The image sensor, if any. A fault that is set takes effect with the sensor's next frame.
    pub fn image_sensor(&mut self) -> Option<&mut ImageSensor> {
        self.bus.devices.gesture.sensor()
    }

    /// Runs to the next vertical blanking, and returns the frame that is shown from that time on. While scan-out is disabled, this frame is
    /// black and keeps the size of the last frame.
    pub fn capture(&mut self) -> Frame {
        let blanking = self.bus.devices.scanout.next_blanking();
        self.run(blanking + 1 - self.cycles);
        self.shown()
    }

    /// Returns the frame on the monitor in the form of [`capture`](Self::capture), without running the board.
    #[must_use]
    pub fn shown(&self) -> Frame {
        self.bus.devices.scanout.frame(&self.bus.ram)
    }

    /// Number of vertical blankings since the start; the displayed frame changes only at a blanking.
    #[must_use]
    pub fn blankings(&self) -> u64 {
        self.bus.devices.scanout.blankings()
    }

    /// The `length` bytes of main memory from the CPU address `address` on.
    fn memory(&mut self, address: u32, length: usize) -> Result<&mut [u8], Error> {
        let place = self.bus.ram.bytes_mut(address, length);
        place.ok_or(Error::Address { address, length })
    }
}

impl Uart for EmulatedBoard {
    /// Runs for at least `cycles` cycles; the last instruction may end later. A breakpoint ends the run earlier.
    fn run(&mut self, cycles: u64) {
        let end = self.cycles.saturating_add(cycles);
        self.bus.devices.update_lines();
        self.is_at_breakpoint = false;
        while self.cycles < end && !self.is_at_breakpoint {
            let next = self.bus.devices.advance(self.cycles, &mut self.bus.ram);
            let lines = self.bus.devices.interrupts();
            let limit = next.min(end);
            let (now, pause) = if self.bus.devices.controller.holds_cpu {
                (limit, Pause::Ready)
            } else {
                self.cpu.run(&mut self.bus, self.cycles, limit, lines)
            };
            self.cycles = now;
            self.is_at_breakpoint = pause == Pause::Breakpoint;
            if pause == Pause::Asleep && now < limit {
                self.cycles = self.bus.devices.sleep(end, &mut self.bus.ram);
            }
            if std::mem::take(&mut self.bus.devices.controller.reset) {
                self.bus.devices.reset();
                self.cpu.reset();
            }
        }
        // The last instruction may have waited for the bus beyond the time of an event.
        self.bus.devices.advance(self.cycles, &mut self.bus.ram);
    }

    fn cycles(&self) -> u64 {
        self.cycles
    }

    fn clock_hz(&self) -> u32 {
        CONFIG_CLOCK_FREQUENCY
    }

    fn uart_write(&mut self, bytes: &[u8]) {
        self.bus.devices.uart.push(bytes);
    }

    fn uart_queued(&self) -> usize {
        self.bus.devices.uart.queued()
    }

    fn uart_output(&mut self) -> &mut Vec<u8> {
        self.bus.devices.uart.sent()
    }
}

impl Simulation for EmulatedBoard {
    fn boot(&mut self, program: &[u8]) -> Result<(), BoardError> {
        self.write_memory(MAIN_RAM.base, program)?;
        self.bus.set_rom(&jump(MAIN_RAM.base));
        self.bus.devices.reset();
        self.cpu.reset();
        Ok(())
    }

    fn set_buttons(&mut self, pressed: u8) {
        self.bus.devices.buttons.set(pressed.into());
    }

    fn set_switches(&mut self, on: u16) {
        self.bus.devices.switches.set(on.into());
    }

    fn leds(&self) -> u16 {
        self.bus.devices.leds.levels
    }

    fn digits(&self) -> [u8; 8] {
        self.bus.devices.digits.segments
    }

    fn plug(&mut self, sensor: Wires) {
        self.bus.devices.i2c.sensor = Some(sensor);
    }

    fn plug_flash(&mut self, flash: Flash) {
        self.bus.flash = flash;
        self.cpu.forget_code();
    }

    fn plug_image_sensor(&mut self, image_sensor: ImageSensor) {
        self.bus.devices.gesture.plug(image_sensor);
    }

    fn read_memory(&mut self, address: u32, bytes: &mut [u8]) -> Result<(), BoardError> {
        let place = self.memory(address, bytes.len());
        bytes.copy_from_slice(place.map_err(BoardError::simulation)?);
        Ok(())
    }

    fn write_memory(&mut self, address: u32, bytes: &[u8]) -> Result<(), BoardError> {
        let place = self.memory(address, bytes.len());
        place
            .map_err(BoardError::simulation)?
            .copy_from_slice(bytes);
        self.cpu.forget_code();
        Ok(())
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

/// Returns a program that jumps to `address`, a multiple of 4096: `lui t0, …; jalr zero, t0`.
fn jump(address: u32) -> Vec<u8> {
    let program = [address | 5 << 7 | 0x37, 5 << 15 | 0x67_u32];
    program.into_iter().flat_map(u32::to_le_bytes).collect()
}
