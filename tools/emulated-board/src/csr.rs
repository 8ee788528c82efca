//! Control and status registers of the CPU.

/// Bit of the external interrupt in `mie` and `mip`, and its number in `mcause`.
const EXTERNAL: u32 = 11;
/// Bits of `mie` that VexRiscv implements: external, timer and software interrupt.
const MIE_BITS: u32 = 1 << EXTERNAL | 1 << 7 | 1 << 3;
/// Bit MIE of `mstatus`.
const INTERRUPTS: u32 = 1 << 3;
/// Bit MPIE of `mstatus`.
const INTERRUPTS_BEFORE: u32 = 1 << 7;
/// Bits MPP of `mstatus`.
const PRIVILEGE_BEFORE: u32 = 3 << 11;
const MSTATUS_BITS: u32 = PRIVILEGE_BEFORE | INTERRUPTS_BEFORE | INTERRUPTS;
/// Bits of `mcause` that VexRiscv implements.
const MCAUSE_BITS: u32 = 1 << 31 | 0xf;
/// Value of the register that describes VexRiscv's data cache: its size in bytes, and from bit 20 on the size of a line in bytes.
const CACHE: u32 = 32 << 20 | 4096;
/// Values of `mvendorid` and `marchid`, equal to VexRiscv's, and of `mimpid`, by which the firmware
/// identifies the emulated board.
const IDENTIFIERS: [u32; 3] = [11, 22, litex_pac::EMULATED];

/// Causes of exceptions, as in `mcause`.
pub mod cause {
    /// Jump to an address that is not a multiple of 4.
    pub const FETCH_MISALIGNED: u32 = 0;
    /// An instruction or a control register that the CPU does not implement.
    pub const ILLEGAL: u32 = 2;
    /// Load from an address that is not a multiple of its size.
    pub const LOAD_MISALIGNED: u32 = 4;
    /// Store to an address that is not a multiple of its size.
    pub const STORE_MISALIGNED: u32 = 6;
    /// `ecall`.
    pub const CALL: u32 = 11;
}

/// Whether the value of register `number` depends on time or on the kind of board: counters, pending interrupts, and the implementation
/// number.
pub fn depends_on_time(number: u32) -> bool {
    matches!(number, 0x344 | 0xfc0 | 0xb00..=0xb8f | 0xc00..=0xc8f | 0xf13)
}

/// Values of the CPU's counters at an instruction.
#[derive(Clone, Copy)]
pub struct Counts {
    /// Number of clock cycles since the start.
    pub cycles: u64,
    /// Number of instructions since the start.
    pub retired: u64,
}

/// The control and status registers of VexRiscv `full`, which has machine mode only.
pub struct Csrs {
    mstatus: u32,
    mie: u32,
    mtvec: u32,
    mepc: u32,
    mcause: u32,
    mtval: u32,
    mscratch: u32,
    misa: u32,
    /// Mask of the interrupt lines that reach the CPU: VexRiscv's register 0xBC0.
    mask: u32,
    /// Levels of the interrupt lines.
    pub lines: u32,
    /// Offsets of `mcycle` and `minstret` from [`Counts`], set by writes to these registers.
    written: [u64; 2],
}

impl Csrs {
    /// The registers after a reset.
    pub fn new() -> Self {
        Self {
            mstatus: PRIVILEGE_BEFORE,
            mie: 0,
            mtvec: 0,
            mepc: 0,
            mcause: 0,
            mtval: 0,
            mscratch: 0,
            misa: 0x4000_0042,
            mask: 0,
            lines: 0,
            written: [0; 2],
        }
    }

    /// Executes the instruction `word`, which accesses a control register, with the operand `source`. Returns the value for the destination
    /// register; `None` for an illegal access.
    pub fn execute(&mut self, word: u32, source: u32, counts: Counts) -> Option<u32> {
        let number = word >> 20;
        let field = word >> 15 & 31;
        let (reads, kind) = (word >> 7 & 0x7f != 0x20, word >> 12 & 3);
        let value = self.read(number, counts)?;
        if number >> 10 == 3 {
            // The register is read-only. If an instruction reads and writes such a register, VexRiscv ignores the write.
            return reads.then_some(value);
        }
        let operand = if word >> 14 & 1 == 1 { field } else { source };
        match kind {
            1 => self.write(number, operand, counts),
            2 if field != 0 => self.write(number, value | operand, counts),
            3 if field != 0 => self.write(number, value & !operand, counts),
            _ => {}
        }
        Some(value)
    }

    fn read(&self, number: u32, counts: Counts) -> Option<u32> {
        let cycles = counts.cycles.wrapping_add(self.written[0]);
        let retired = counts.retired.wrapping_add(self.written[1]);
        Some(match number {
            0x300 => self.mstatus,
            0x301 => self.misa,
            0x304 => self.mie,
            0x305 => self.mtvec,
            0x340 => self.mscratch,
            0x341 => self.mepc,
            0x342 => self.mcause,
            0x343 => self.mtval,
            0x344 => self.pending(),
            0xbc0 => self.mask,
            0xfc0 => self.mask & self.lines,
            0xb00 | 0xc00 => cycles as u32,
            0xb80 | 0xc80 => (cycles >> 32) as u32,
            0xb02 | 0xc02 => retired as u32,
            0xb82 | 0xc82 => (retired >> 32) as u32,
            0xcc0 => CACHE,
            0xf11..=0xf13 => IDENTIFIERS[number as usize - 0xf11],
            0xf14 => 0,
            _ => return None,
        })
    }

    fn write(&mut self, number: u32, value: u32, counts: Counts) {
        let low = |whole: u64| whole & !0xffff_ffff | u64::from(value);
        let high = |whole: u64| whole & 0xffff_ffff | u64::from(value) << 32;
        let [cycles, retired] = [counts.cycles, counts.retired];
        let now = [
            cycles.wrapping_add(self.written[0]),
            retired.wrapping_add(self.written[1]),
        ];
        match number {
            0x300 => self.mstatus = value & MSTATUS_BITS,
            0x301 => self.misa = value & 0xc3ff_ffff,
            0x304 => self.mie = value & MIE_BITS,
            0x305 => self.mtvec = value,
            0x340 => self.mscratch = value,
            0x341 => self.mepc = value,
            0x342 => self.mcause = value & MCAUSE_BITS,
            0x343 => self.mtval = value,
            0xbc0 => self.mask = value,
            0xb00 => self.written[0] = low(now[0]).wrapping_sub(cycles),
            0xb80 => self.written[0] = high(now[0]).wrapping_sub(cycles),
            0xb02 => self.written[1] = low(now[1]).wrapping_sub(retired),
            0xb82 => self.written[1] = high(now[1]).wrapping_sub(retired),
            _ => {}
        }
    }

    /// The register `mip`.
    fn pending(&self) -> u32 {
        u32::from(self.mask & self.lines != 0) << EXTERNAL
    }

    /// Whether an enabled interrupt is pending; such an interrupt ends `wfi`.
    pub fn wakes(&self) -> bool {
        self.pending() & self.mie != 0
    }

    /// Takes a pending interrupt before the instruction at `pc`, if interrupts are enabled; returns the handler's address.
    pub fn interrupt(&mut self, pc: u32) -> Option<u32> {
        (self.mstatus & INTERRUPTS != 0 && self.wakes()).then(|| self.enter(1 << 31 | EXTERNAL, pc))
    }

    /// Takes the exception of the instruction at `pc`; returns the handler's address.
    pub fn exception(&mut self, cause: u32, value: u32, pc: u32) -> u32 {
        self.mtval = value;
        self.enter(cause, pc)
    }

    fn enter(&mut self, cause: u32, pc: u32) -> u32 {
        self.mcause = cause;
        self.mepc = pc;
        let enabled = self.mstatus & INTERRUPTS != 0;
        self.mstatus = PRIVILEGE_BEFORE | if enabled { INTERRUPTS_BEFORE } else { 0 };
        self.mtvec & !3
    }

    /// Executes `mret`; returns the address of the next instruction.
    pub fn mret(&mut self) -> u32 {
        let enabled = self.mstatus & INTERRUPTS_BEFORE != 0;
        self.mstatus = INTERRUPTS_BEFORE | if enabled { INTERRUPTS } else { 0 };
        self.mepc & !3
    }
}
