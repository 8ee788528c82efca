//! The CPU VexRiscv `full` (rv32im with machine mode), as an interpreter of decoded instructions.

mod lockstep;

use crate::bus::Bus;
use crate::csr::{Counts, Csrs, cause};
use crate::decode::{Instruction, Operation};
use crate::instruction_cache::{InstructionCache, PAGE};

pub use lockstep::{Difference, Executed};

/// Estimated number of clock cycles per instruction: the mean of the real CPU.
pub const CYCLES: u64 = 1;

/// The CPU.
pub struct Cpu {
    /// The registers. Discarded results are written to element 32. The length is a power of 2, so
    /// that an index masked to 6 bits is always valid.
    x: [u32; 64],
    pc: u32,
    csrs: Csrs,
    code: InstructionCache,
    /// Number of executed instructions since the start.
    retired: u64,
    /// Whether the last instruction was `wfi` and no interrupt has become pending since then.
    asleep: bool,
    /// Addresses whose instructions are not executed. They are never decoded, so other instructions take no time for a check.
    pub breakpoints: Vec<u32>,
}

/// Reason why [`Cpu::run`] returned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pause {
    /// The limit is reached, or a device was accessed.
    Ready,
    /// The CPU sleeps until an interrupt is pending.
    Asleep,
    /// The next instruction has a breakpoint.
    Breakpoint,
}

impl Cpu {
    /// The CPU after a reset.
    pub fn new() -> Self {
        Self {
            x: [0; 64],
            pc: litex_pac::constants::CONFIG_CPU_RESET_ADDR,
            csrs: Csrs::new(),
            code: InstructionCache::new(),
            retired: 0,
            asleep: false,
            breakpoints: Vec::new(),
        }
    }

    /// Resets the CPU; its counters continue, and breakpoints stay.
    pub fn reset(&mut self) {
        *self = Self {
            retired: self.retired,
            breakpoints: std::mem::take(&mut self.breakpoints),
            ..Self::new()
        };
    }

    /// The registers x0 to x31.
    pub fn registers(&self) -> [u32; 32] {
        std::array::from_fn(|number| self.x[number])
    }

    /// Sets the registers; x0 stays 0.
    pub fn set_registers(&mut self, registers: &[u32; 32]) {
        self.x[1..32].copy_from_slice(&registers[1..]);
    }

    /// The address of the next instruction.
    pub fn pc(&self) -> u32 {
        self.pc
    }

    /// Sets the address of the next instruction, and wakes the CPU.
    pub fn set_pc(&mut self, pc: u32) {
        (self.pc, self.asleep) = (pc, false);
    }

    /// Number of executed instructions since the start.
    pub fn retired(&self) -> u64 {
        self.retired
    }

    /// Discards all decoded instructions, after a write to memory by a device or the host.
    pub fn forget_code(&mut self) {
        self.code.clear();
    }

    /// Runs from cycle `now` to cycle `limit` or slightly beyond. Returns the cycle after the last
    /// instruction, and the reason for the return. Returns before `limit` when the CPU sleeps, and
    /// after each access to a device, because the access may change the interrupt `lines`.
    pub fn run(&mut self, bus: &mut Bus, now: u64, limit: u64, lines: u32) -> (u64, Pause) {
        self.csrs.lines = lines;
        if self.asleep {
            if !self.csrs.wakes() {
                return (now, Pause::Asleep);
            }
            self.asleep = false;
        }
        if let Some(handler) = self.csrs.interrupt(self.pc) {
            self.pc = handler;
        }
        let mut at = now;
        let mut waited = 0;
        let mut pause = Pause::Ready;
        while at < limit {
            let end = self.run_page(bus, now + waited, at, limit);
            at = end.now;
            waited += end.waited;
            match end.reason {
                Reason::Page => {}
                Reason::Device => break,
                Reason::Control => {
                    if let Some(handler) = self.csrs.interrupt(self.pc) {
                        self.pc = handler;
                    }
                }
                Reason::Wait if self.csrs.wakes() => {}
                Reason::Wait => {
                    self.asleep = true;
                    pause = Pause::Asleep;
                    break;
                }
                Reason::Breakpoint => {
                    pause = Pause::Breakpoint;
                    break;
                }
            }
        }
        self.retired += (at - now - waited) / CYCLES;
        (at, pause)
    }

    /// Runs instructions of the page at the program counter, up to the first instruction that leaves the page or has an effect beyond
    /// registers and memory.
    #[inline(never)]
    fn run_page(&mut self, bus: &mut Bus, began: u64, mut now: u64, limit: u64) -> End {
        let Self {
            x,
            pc: stored_pc,
            csrs,
            code,
            retired,
            breakpoints,
            ..
        } = self;
        let retired = *retired;
        let mut pc = *stored_pc;
        let number = pc / PAGE;
        let page = code.page(number);
        let mut reason = Reason::Page;
        let mut waited = 0;
        macro_rules! end {
            ($reason:expr) => {{
                reason = $reason;
                break;
            }};
        }
        macro_rules! exception {
            ($cause:expr, $value:expr) => {{
                // An instruction that traps takes time, but is not counted as retired.
                waited += CYCLES;
                pc = csrs.exception($cause, $value, pc);
                continue;
            }};
        }
        while now < limit && pc / PAGE == number {
            let place = &mut page[(pc % PAGE / 4) as usize];
            let instruction = *place;
            let Instruction {
                operation,
                rd,
                rs1,
                rs2,
                immediate,
            } = instruction;
            let (rd, a, b) = (
                usize::from(rd & 63),
                x[usize::from(rs1 & 63)],
                x[usize::from(rs2 & 63)],
            );
            let mut next = pc.wrapping_add(4);
            macro_rules! branch {
                ($taken:expr) => {
                    if $taken {
                        let target = pc.wrapping_add(immediate);
                        if target & 2 != 0 {
                            now += CYCLES;
                            exception!(cause::FETCH_MISALIGNED, target);
                        }
                        next = target;
                    }
                };
            }
            macro_rules! load {
                ($size:literal, $convert:expr) => {{
                    let address = a.wrapping_add(immediate);
                    if !address.is_multiple_of($size) {
                        now += CYCLES;
                        exception!(cause::LOAD_MISALIGNED, address);
                    }
                    match bus.ram.array::<$size>(address) {
                        Some(bytes) => x[rd] = $convert(bytes),
                        None => {
                            let access = bus.load(address, now);
                            let word = access.value >> (8 * (address & 3));
                            let bytes = word.to_le_bytes();
                            x[rd] = $convert(std::array::from_fn::<u8, $size, _>(|at| bytes[at]));
                            waited += access.cycles;
                            now += access.cycles;
                            if access.device {
                                now += CYCLES;
                                pc = next;
                                end!(Reason::Device);
                            }
                        }
                    }
                }};
            }
            macro_rules! store {
                ($size:literal) => {{
                    let address = a.wrapping_add(immediate);
                    if !address.is_multiple_of($size) {
                        now += CYCLES;
                        exception!(cause::STORE_MISALIGNED, address);
                    }
                    let bytes = b.to_le_bytes();
                    let bytes = std::array::from_fn::<u8, $size, _>(|at| bytes[at]);
                    if bus.ram.set_array(address, bytes).is_none() {
                        let access = bus.store(address, b, $size, now);
                        waited += access.cycles;
                        now += access.cycles;
                        if access.device {
                            now += CYCLES;
                            pc = next;
                            end!(Reason::Device);
                        }
                    }
                }};
            }
            use Operation::*;
            match operation {
                Unknown => {
                    if breakpoints.contains(&pc) {
                        end!(Reason::Breakpoint);
                    }
                    if let Some(word) = bus.memory_word(pc) {
                        *place = Instruction::decode(word);
                        continue;
                    }
                    // After a time-out the bus returns an illegal instruction word.
                    let access = bus.fetch(pc, now);
                    waited += access.cycles;
                    now += access.cycles + CYCLES;
                    exception!(cause::ILLEGAL, access.value);
                }
                Illegal => {
                    now += CYCLES;
                    exception!(cause::ILLEGAL, immediate)
                }
                Lui => x[rd] = immediate,
                Auipc => x[rd] = pc.wrapping_add(immediate),
                Jal => {
                    branch!(true);
                    x[rd] = pc.wrapping_add(4);
                }
                Jalr => {
                    let target = a.wrapping_add(immediate) & !1;
                    if target & 2 != 0 {
                        now += CYCLES;
                        exception!(cause::FETCH_MISALIGNED, target);
                    }
                    x[rd] = next;
                    next = target;
                }
                Beq => branch!(a == b),
                Bne => branch!(a != b),
                Blt => branch!((a as i32) < b as i32),
                Bge => branch!(a as i32 >= b as i32),
                Bltu => branch!(a < b),
                Bgeu => branch!(a >= b),
                Lb => load!(1, |bytes| i8::from_le_bytes(bytes) as u32),
                Lh => load!(2, |bytes| i16::from_le_bytes(bytes) as u32),
                Lw => load!(4, u32::from_le_bytes),
                Lbu => load!(1, |bytes| u32::from(u8::from_le_bytes(bytes))),
                Lhu => load!(2, |bytes| u32::from(u16::from_le_bytes(bytes))),
                Sb => store!(1),
                Sh => store!(2),
                Sw => store!(4),
                Addi => x[rd] = a.wrapping_add(immediate),
                Slti => x[rd] = u32::from((a as i32) < immediate as i32),
                Sltiu => x[rd] = u32::from(a < immediate),
                Xori => x[rd] = a ^ immediate,
                Ori => x[rd] = a | immediate,
                Andi => x[rd] = a & immediate,
                Slli => x[rd] = a.wrapping_shl(immediate),
                Srli => x[rd] = a.wrapping_shr(immediate),
                Srai => x[rd] = (a as i32).wrapping_shr(immediate) as u32,
                Add => x[rd] = a.wrapping_add(b),
                Sub => x[rd] = a.wrapping_sub(b),
                Sll => x[rd] = a.wrapping_shl(b),
                Slt => x[rd] = u32::from((a as i32) < b as i32),
                Sltu => x[rd] = u32::from(a < b),
                Xor => x[rd] = a ^ b,
                Srl => x[rd] = a.wrapping_shr(b),
                Sra => x[rd] = (a as i32).wrapping_shr(b) as u32,
                Or => x[rd] = a | b,
                And => x[rd] = a & b,
                Mul => x[rd] = a.wrapping_mul(b),
                Mulh => x[rd] = ((i64::from(a as i32) * i64::from(b as i32)) >> 32) as u32,
                Mulhsu => x[rd] = ((i64::from(a as i32) * i64::from(b)) >> 32) as u32,
                Mulhu => x[rd] = ((u64::from(a) * u64::from(b)) >> 32) as u32,
                Div => {
                    x[rd] = match b {
                        0 => u32::MAX,
                        _ => (a as i32).wrapping_div(b as i32) as u32,
                    }
                }
                Divu => x[rd] = a.checked_div(b).unwrap_or(u32::MAX),
                Rem => {
                    x[rd] = match b {
                        0 => a,
                        _ => (a as i32).wrapping_rem(b as i32) as u32,
                    }
                }
                Remu => x[rd] = a.checked_rem(b).unwrap_or(a),
                Fence => {}
                FenceI => {
                    now += CYCLES;
                    pc = next;
                    code.clear();
                    end!(Reason::Page);
                }
                Ecall => {
                    now += CYCLES;
                    exception!(cause::CALL, immediate)
                }
                Mret => {
                    now += CYCLES;
                    pc = csrs.mret();
                    end!(Reason::Control);
                }
                Wfi => {
                    now += CYCLES;
                    pc = next;
                    end!(Reason::Wait);
                }
                Csr => {
                    let counts = Counts {
                        cycles: now,
                        retired: retired + (now - began - waited) / CYCLES,
                    };
                    now += CYCLES;
                    match csrs.execute(immediate, a, counts) {
                        Some(value) => x[rd] = value,
                        None => exception!(cause::ILLEGAL, immediate),
                    }
                    pc = next;
                    end!(Reason::Control);
                }
            }
            now += CYCLES;
            pc = next;
        }
        *stored_pc = pc;
        End {
            now,
            waited,
            reason,
        }
    }
}

/// Reason why [`Cpu::run_page`] returned, and the cycle after the last instruction.
struct End {
    now: u64,
    /// Number of cycles without a retired instruction, because of time-outs of the bus or traps.
    waited: u64,
    reason: Reason,
}

enum Reason {
    /// The limit is reached, the next instruction is in another page, or the decoded instructions were discarded.
    Page,
    /// A device was accessed.
    Device,
    /// A control register was accessed, or the program returned from a trap handler.
    Control,
    /// The instruction `wfi` was executed.
    Wait,
    /// The next instruction has a breakpoint.
    Breakpoint,
}
