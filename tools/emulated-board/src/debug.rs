//! Access for debuggers: registers, memories, breakpoints, single instructions.

use glint_board_api::Uart;

use crate::EmulatedBoard;

/// Maximum time that [`EmulatedBoard::step`] waits for a sleeping CPU, as the divisor of a second of the board's time.
const LONGEST_SLEEP: u64 = 10;

impl EmulatedBoard {
    /// The integer registers x0 to x31.
    #[must_use]
    pub fn registers(&self) -> [u32; 32] {
        self.cpu.registers()
    }

    /// Sets the integer registers; x0 stays 0.
    pub fn set_registers(&mut self, registers: &[u32; 32]) {
        self.cpu.set_registers(registers);
    }

    /// The address of the next instruction.
    #[must_use]
    pub fn pc(&self) -> u32 {
        self.cpu.pc()
    }

    /// Sets the address of the next instruction, which a sleeping CPU executes at once.
    pub fn set_pc(&mut self, pc: u32) {
        self.cpu.set_pc(pc);
    }

    /// The breakpoints: [`run`](Uart::run) ends before the instruction at each of these addresses.
    #[must_use]
    pub fn breakpoints(&self) -> &[u32] {
        &self.cpu.breakpoints
    }

    /// Adds a breakpoint, unless one exists at this address.
    pub fn add_breakpoint(&mut self, address: u32) {
        if !self.cpu.breakpoints.contains(&address) {
            self.cpu.breakpoints.push(address);
            self.cpu.forget_code();
        }
    }

    /// Removes a breakpoint. Returns whether one existed at this address.
    pub fn remove_breakpoint(&mut self, address: u32) -> bool {
        let count = self.cpu.breakpoints.len();
        self.cpu.breakpoints.retain(|known| *known != address);
        self.cpu.breakpoints.len() < count
    }

    /// Whether the last [`run`](Uart::run) ended at a breakpoint.
    #[must_use]
    pub fn is_at_breakpoint(&self) -> bool {
        self.is_at_breakpoint
    }

    /// Executes the next instruction, even at a breakpoint. A sleeping CPU first waits for an interrupt, for at most a tenth of a second.
    pub fn step(&mut self) {
        let breakpoints = std::mem::take(&mut self.cpu.breakpoints);
        let executed = self.instructions();
        let end = self.cycles() + u64::from(self.clock_hz()) / LONGEST_SLEEP;
        while self.instructions() == executed && self.cycles() < end {
            self.run(1);
        }
        self.cpu.breakpoints = breakpoints;
        // The instruction of a breakpoint must not stay decoded.
        self.cpu.forget_code();
    }

    /// Reads bytes from `address` on, and returns their number: reading ends at the first address that is not in a memory. Registers of
    /// devices are not read, because a read may have effects.
    #[must_use]
    pub fn peek(&self, address: u32, bytes: &mut [u8]) -> usize {
        let mut count = 0;
        for (place, address) in bytes.iter_mut().zip(address..=u32::MAX) {
            let Some(word) = self.bus.memory_word(address & !3) else {
                break;
            };
            *place = word.to_le_bytes()[address as usize & 3];
            count += 1;
        }
        count
    }

    /// Writes `bytes` from `address` on. Returns whether all of them are in main memory, or all in SRAM; otherwise none is written.
    pub fn poke(&mut self, address: u32, bytes: &[u8]) -> bool {
        let written = match self.bus.ram.bytes_mut(address, bytes.len()) {
            Some(place) => {
                place.copy_from_slice(bytes);
                true
            }
            None => self.bus.write_sram(address, bytes),
        };
        self.cpu.forget_code();
        written
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use litex_pac::memories::{MAIN_RAM, ROM, SRAM};

    /// `addi t0, t0, 1; jal zero, -4`.
    const LOOP: [u32; 2] = [0x0012_8293, 0xffdf_f06f];

    fn board() -> EmulatedBoard {
        EmulatedBoard::fast(LOOP.map(u32::to_le_bytes).as_flattened()).unwrap()
    }

    #[test]
    fn a_run_ends_at_a_breakpoint_and_a_step_leaves_it() {
        let mut board = board();
        let (first, second) = (MAIN_RAM.base, MAIN_RAM.base + 4);
        board.run(1000);
        assert!(!board.is_at_breakpoint());
        board.add_breakpoint(second);
        board.add_breakpoint(second);
        assert_eq!(board.breakpoints(), [second]);
        board.run(1000);
        let counted = board.registers()[5];
        for round in 0..3 {
            assert!(board.is_at_breakpoint());
            assert_eq!(
                (board.pc(), board.registers()[5]),
                (second, counted + round)
            );
            // Without a step the board stays at the breakpoint.
            board.run(1000);
            assert_eq!(board.pc(), second);
            board.step();
            assert_eq!(board.pc(), first);
            board.run(1000);
        }
        board.step();
        assert!(board.remove_breakpoint(second) && !board.remove_breakpoint(second));
        board.run(1000);
        assert!(!board.is_at_breakpoint() && board.registers()[5] > counted + 400);
    }

    #[test]
    fn registers_and_memories_are_read_and_written() {
        let mut board = board();
        board.run(100);
        let mut registers = board.registers();
        (registers[0], registers[5], registers[31]) = (7, 1000, 9);
        board.set_registers(&registers);
        board.set_pc(MAIN_RAM.base);
        board.step();
        let found = board.registers();
        assert_eq!((found[0], found[5], found[31]), (0, 1001, 9));
        let mut bytes = [0; 6];
        assert_eq!(board.peek(MAIN_RAM.base + 2, &mut bytes), 6);
        assert_eq!(bytes, [0x12, 0x00, 0x6f, 0xf0, 0xdf, 0xff]);
        // The increment becomes 2, although the instruction was decoded before.
        assert!(board.poke(MAIN_RAM.base + 2, &[0x22]));
        board.set_pc(MAIN_RAM.base);
        board.step();
        assert_eq!(board.registers()[5], 1003);
        assert!(board.poke(SRAM.base + 1, &[1, 2]));
        assert_eq!(board.peek(SRAM.base, &mut bytes[..3]), 3);
        assert_eq!(bytes[..3], [0, 1, 2]);
        // Reading ends at the end of a memory; memories that the CPU cannot write stay unchanged.
        assert_eq!(board.peek(MAIN_RAM.base + MAIN_RAM.size - 2, &mut bytes), 2);
        assert_eq!(board.peek(0xf000_0000, &mut bytes), 0);
        assert_eq!(board.peek(u32::MAX, &mut bytes), 0);
        assert!(!board.poke(ROM.base, &[1]) && !board.poke(SRAM.base + SRAM.size - 1, &[1, 2]));
    }
}
