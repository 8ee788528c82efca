//! Compares the emulated CPU with the verilated CPU. Random programs store their registers, memory and traps in main memory, which must be
//! equal on both boards. The firmware must execute the same instructions with equal results.

use std::fmt::Write;
use virtual_board::{Simulation, Uart};

use emulated_board::{EmulatedBoard, Executed};
use glint_vectors::Random;
use litex_pac::ctrl;
use litex_pac::memories::{MAIN_RAM, SRAM};
use virtual_board::Instruction;

use crate::console::committed;
use crate::firmware::{PROMPT, image, preloaded};

/// Number of random instructions of a program; its registers are stored after them.
const BODY: usize = 64;
/// Number of programs in an image.
const PROGRAMS: usize = 1500;
/// Default number of random instructions of the test: those of one image. `GLINT_LOCKSTEP`
/// overrides it.
const INSTRUCTIONS: usize = BODY * PROGRAMS;

/// Addresses of the trap handler, the first program, the results (32 words per program), the traps (four words per trap), and the data
/// window.
const HANDLER: u32 = MAIN_RAM.base + 0x200;
const FIRST: u32 = MAIN_RAM.base + 0x400;
const RESULTS: u32 = 0x4600_0000;
const TRAPS: u32 = 0x4700_0000;
const DATA: u32 = 0x47f0_0000;
/// Address of the word after the last program's results. The word is not 0 after the end of all
/// programs.
const DONE: u32 = RESULTS + 128 * PROGRAMS as u32;

/// Number of bytes of the data window, which loads and stores address relative to its middle.
const WINDOW: u32 = 4096;
/// Time-out for the run of an image, in cycles.
const LIMIT: u64 = 100_000_000;

/// Registers with a fixed purpose, which random instructions do not write.
const REGISTERS: u32 = 26;
const FAST: u32 = 27;
/// Start of the current program, for indirect jumps.
const START: u32 = 28;
const TRAP: u32 = 29;
const RESULT: u32 = 30;
const WINDOW_MIDDLE: u32 = 31;

const MSCRATCH: u32 = 0x340;
const MEPC: u32 = 0x341;
const MCAUSE: u32 = 0x342;
const MTVAL: u32 = 0x343;
const MSTATUS: u32 = 0x300;
const MTVEC: u32 = 0x305;
const MIP: u32 = 0x344;

/// Control registers that random instructions access; some of them do not exist. The list excludes
/// registers for time, for the trap handler and for the implementation.
const CSRS: [u32; 19] = [
    MSTATUS, 0x301, 0x304, MSCRATCH, MEPC, MCAUSE, MTVAL, 0xbc0, 0xfc0, 0xcc0, 0xf11, 0xf12, 0xf14,
    0x180, 0x306, 0x7c0, 0xc01, 0xf15, 0x105,
];

fn r(funct7: u32, rs2: u32, rs1: u32, funct3: u32, rd: u32, opcode: u32) -> u32 {
    funct7 << 25 | rs2 << 20 | rs1 << 15 | funct3 << 12 | rd << 7 | opcode
}

fn i(immediate: u32, rs1: u32, funct3: u32, rd: u32, opcode: u32) -> u32 {
    (immediate & 0xfff) << 20 | rs1 << 15 | funct3 << 12 | rd << 7 | opcode
}

fn s(immediate: u32, rs2: u32, rs1: u32, funct3: u32) -> u32 {
    r(
        immediate >> 5 & 0x7f,
        rs2,
        rs1,
        funct3,
        immediate & 31,
        0x23,
    )
}

fn sw(rs2: u32, offset: u32, rs1: u32) -> u32 {
    s(offset, rs2, rs1, 2)
}

/// `jal`, forward by `offset` bytes, below 2 KB.
fn jal(rd: u32, offset: u32) -> u32 {
    (offset & 0x7fe) << 20 | rd << 7 | 0x6f
}

/// `lui` and `addi`: loads a constant.
fn li(rd: u32, value: u32) -> [u32; 2] {
    let upper = value.wrapping_add(0x800) & 0xffff_f000;
    [upper | rd << 7 | 0x37, i(value, rd, 0, rd, 0x13)]
}

fn csrrw(rd: u32, csr: u32, rs1: u32) -> u32 {
    i(csr, rs1, 1, rd, 0x73)
}

fn csrr(rd: u32, csr: u32) -> u32 {
    i(csr, 0, 2, rd, 0x73)
}

/// Returns code that loads constants into all registers, the trap handler, and a jump over the
/// handler.
fn set_up(random: &mut Random) -> Vec<u32> {
    let mut code: Vec<u32> = (1..32).flat_map(|x| li(x, random.bits() as u32)).collect();
    for (x, value) in [
        (REGISTERS, ctrl::Ctrl::BASE as u32),
        (FAST, SRAM.base + WINDOW / 2),
        (TRAP, TRAPS),
        (RESULT, RESULTS),
        (WINDOW_MIDDLE, DATA + WINDOW / 2),
        (START, HANDLER),
    ] {
        code.extend(li(x, value));
    }
    code.push(csrrw(0, MTVEC, START));
    code.push(jal(0, FIRST - MAIN_RAM.base - 4 * code.len() as u32));
    place(&mut code, HANDLER);
    code.extend(handler());
    place(&mut code, FIRST);
    code
}

/// Fills `code` with zeros up to `address`.
fn place(code: &mut Vec<u32>, address: u32) {
    let length = ((address - MAIN_RAM.base) / 4) as usize;
    assert!(
        code.len() <= length,
        "{} words before {address:#x}",
        code.len()
    );
    code.resize(length, 0);
}

/// Returns a trap handler that stores cause, value and address of the trap, and continues with the
/// next instruction.
fn handler() -> Vec<u32> {
    let stored = [MCAUSE, MTVAL, MSTATUS, MEPC]
        .into_iter()
        .zip([0, 4, 8, 12]);
    let mut code = vec![csrrw(0, MSCRATCH, START)];
    code.extend(stored.flat_map(|(csr, offset)| [csrr(START, csr), sw(START, offset, TRAP)]));
    code.extend([
        i(4, START, 0, START, 0x13),
        csrrw(0, MEPC, START),
        i(16, TRAP, 0, TRAP, 0x13),
        csrr(START, MSCRATCH),
        0x3020_0073,
    ]);
    code
}

/// A register that random instructions may write.
fn destination(random: &mut Random) -> u32 {
    loop {
        let x = register(random);
        if x < REGISTERS {
            return x;
        }
    }
}

fn register(random: &mut Random) -> u32 {
    random.bits() as u32 & 31
}

/// A number from 0 to `below` - 1.
fn number(random: &mut Random, below: u32) -> u32 {
    random.integer(0, i64::from(below) - 1) as u32
}

/// An immediate value of 12 bits.
fn immediate(random: &mut Random) -> u32 {
    random.bits() as u32 & 0xfff
}

/// An operand address: a register that holds a memory address, and an offset; or the scratch register of the SoC's controller.
fn operand(random: &mut Random) -> (u32, u32) {
    let offset = immediate(random);
    match number(random, 8) {
        0 => (REGISTERS, ctrl::offset::SCRATCH + number(random, 4)),
        1 | 2 => (FAST, offset),
        _ => (WINDOW_MIDDLE, offset),
    }
}

/// A word that is not an instruction of rv32im with machine mode.
fn illegal(random: &mut Random) -> u32 {
    const LEGAL: [u32; 11] = [
        0x03, 0x0f, 0x13, 0x17, 0x23, 0x33, 0x37, 0x63, 0x67, 0x6f, 0x73,
    ];
    match number(random, 4) {
        // `ebreak`, which this CPU does not implement.
        0 => 0x0010_0073,
        1 => 0,
        _ => loop {
            let word = random.bits() as u32;
            if !LEGAL.contains(&(word & 0x7f)) {
                return word;
            }
        },
    }
}

/// Appends a random instruction to `code`, whose program begins at `start`.
fn instruction(code: &mut Vec<u32>, start: usize, random: &mut Random) {
    let (rd, rs1, rs2, funct3) = (
        destination(random),
        register(random),
        register(random),
        number(random, 8),
    );
    let one = match number(random, 100) {
        0..30 => {
            let funct7 = [0, 0, 1, 1, 0x20, number(random, 128)][number(random, 6) as usize];
            r(funct7, rs2, rs1, funct3, rd, 0x33)
        }
        30..50 => {
            let mut value = immediate(random);
            if funct3 & 3 == 1 && number(random, 8) != 0 {
                value &= 0x41f;
            }
            i(value, rs1, funct3, rd, 0x13)
        }
        50..55 => {
            random.bits() as u32 & 0xffff_f000 | rd << 7 | if random.coin() { 0x37 } else { 0x17 }
        }
        55..67 => {
            let (base, offset) = operand(random);
            i(offset, base, funct3, rd, 0x03)
        }
        67..77 => {
            let (base, offset) = operand(random);
            s(
                offset,
                rs2,
                base,
                funct3 & if number(random, 8) == 0 { 7 } else { 3 },
            )
        }
        77..86 => {
            // A jump forward by up to eight instructions, sometimes to an address that is not a multiple of 4.
            let offset = 4 * (1 + number(random, 8)) + 2 * u32::from(number(random, 16) == 0);
            let funct7 = offset >> 5 & 0x3f;
            r(
                funct7,
                rs2,
                rs1,
                funct3,
                (offset & 0x1e) | offset >> 11 & 1,
                0x63,
            )
        }
        86..88 => jal(
            rd,
            4 * (1 + number(random, 8)) + 2 * u32::from(number(random, 8) == 0),
        ),
        88..90 => {
            // Also forward; the lowest bit of the target is ignored.
            let offset = 4 * (code.len() - start) as u32 + 4 + 4 * number(random, 8);
            i(offset + number(random, 4), START, funct3 & 1, rd, 0x67)
        }
        90..96 => {
            let csr = CSRS[number(random, CSRS.len() as u32) as usize];
            match number(random, 8) {
                0 => csrr(rd, MIP),
                // Writes of zero, and instructions without a destination register.
                1 => i(csr, 0, funct3, rd, 0x73),
                2 => i(csr, rs1, funct3, 0, 0x73),
                _ => i(csr, rs1, funct3, rd, 0x73),
            }
        }
        // `fence`, `fence.i`, and the flush of the data cache.
        96 => [0x0000_000f, 0x0000_100f, 0x0000_500f][number(random, 3) as usize],
        97 => 0x0000_0073,
        _ => illegal(random),
    };
    // Of the instructions with the opcode SYSTEM and funct3 0, only `ecall` and `ebreak` are generated; random other instructions become
    // `ecall`.
    let is_system = one & 0x707f == 0x73 && ![0x73, 0x0010_0073].contains(&one);
    code.push(if is_system { 0x73 } else { one });
}

/// Appends a random program, which finally stores its registers at the address in the register `RESULT`.
fn program(code: &mut Vec<u32>, random: &mut Random) {
    let start = code.len();
    // `auipc`
    code.push(START << 7 | 0x17);
    while code.len() <= start + BODY {
        instruction(code, start, random);
    }
    code.extend((1..32).map(|x| sw(x, 4 * (x - 1), RESULT)));
    code.push(i(128, RESULT, 0, RESULT, 0x13));
}

/// Main memory after a run: results, traps, data.
struct Left {
    results: Vec<u32>,
    traps: Vec<u32>,
    data: Vec<u32>,
}

impl Left {
    /// Runs the programs on a board with the initial `data`. Returns `None` if they do not end.
    fn of(board: &mut impl Simulation, data: &[u8]) -> Option<Self> {
        board.write_memory(DATA, data).expect("main RAM");
        let mut done = [0; 4];
        for _ in 0..LIMIT / SLICE {
            board.run(SLICE);
            board.read_memory(DONE, &mut done).expect("main RAM");
            if done != [0; 4] {
                break;
            }
        }
        let mut words = |address, bytes: usize| {
            let mut buffer = vec![0; bytes];
            board.read_memory(address, &mut buffer).expect("main RAM");
            let words = buffer.as_chunks().0.iter();
            words.map(|word| u32::from_le_bytes(*word)).collect()
        };
        (done != [0; 4]).then(|| Self {
            results: words(RESULTS, 128 * PROGRAMS),
            traps: words(TRAPS, 16 * BODY * PROGRAMS),
            data: words(DATA, WINDOW as usize),
        })
    }
}

/// Runs programs from a random seed on both boards, and compares their results in memory.
fn compare(seed: u64) {
    let mut random = Random(seed);
    let mut code = set_up(&mut random);
    let mut starts = Vec::new();
    for _ in 0..PROGRAMS {
        starts.push(code.len());
        program(&mut code, &mut random);
    }
    starts.push(code.len());
    // Ends the programs: stores a word that is not 0, then loops.
    code.extend([sw(RESULT, 0, RESULT), 0x0000_006f]);
    let image: Vec<u8> = code.iter().flat_map(|word| word.to_le_bytes()).collect();
    let data: Vec<u8> = (0..WINDOW).map(|_| random.bits() as u8).collect();

    let mut emulated = EmulatedBoard::fast(&image).expect("an image that fits");
    let found = Left::of(&mut emulated, &data)
        .unwrap_or_else(|| panic!("seed {seed}: the emulated board did not end"));
    let mut verilated = preloaded(&image);
    let expected = Left::of(&mut verilated, &data)
        .unwrap_or_else(|| panic!("seed {seed}: the virtual board did not end"));

    let results = expected.results.chunks(32).zip(found.results.chunks(32));
    for (number, (expected, found)) in results.enumerate() {
        if expected == found {
            continue;
        }
        let mut listing = String::new();
        let words = code.iter().enumerate();
        for (at, word) in words.take(starts[number + 1]).skip(starts[number]) {
            let address = MAIN_RAM.base + 4 * at as u32;
            writeln!(listing, "{address:#010x}: .word {word:#010x}").expect("a string");
        }
        panic!(
            "seed {seed}, program {number}:\n{listing}x1 to x31: expected {expected:08x?}\nfound {found:08x?}"
        );
    }
    let trap = |left: &Left| left.traps.iter().filter(|word| **word != 0).count();
    println!(
        "seed {seed}: {} cycles, {} words of traps",
        verilated.cycles(),
        trap(&expected)
    );
    assert!(expected.traps == found.traps, "seed {seed}: traps differ");
    assert!(expected.data == found.data, "seed {seed}: data differ");
}

/// `GLINT_LOCKSTEP=10000000` in the environment runs ten million instructions.
#[test]
fn random_programs_leave_the_same_on_both_boards() {
    let count = std::env::var("GLINT_LOCKSTEP").ok();
    let count = count.map_or(INSTRUCTIONS, |text| text.parse().expect("a number"));
    for seed in 0..count.div_ceil(BODY * PROGRAMS) {
        compare(seed as u64);
    }
}

/// Default number of firmware cycles that are compared; `GLINT_LOCKSTEP_CYCLES` overrides it.
const CYCLES: u64 = 3_000_000;

/// Number of cycles between two checks of a board.
const SLICE: u64 = 100_000;

/// Compares each instruction of the firmware, from its start through the commands of the console's transcript.
/// `GLINT_LOCKSTEP_CYCLES=50000000` in the environment compares 50 million cycles.
#[test]
fn the_firmware_executes_the_same_instructions() {
    let cycles = std::env::var("GLINT_LOCKSTEP_CYCLES").ok();
    let cycles = cycles.map_or(CYCLES, |text| text.parse().expect("a number"));
    let firmware = image();
    let mut verilated = preloaded(&firmware);
    let mut emulated = EmulatedBoard::fast(&firmware).expect("firmware that fits");
    verilated.record_instructions(true);

    let (_, transcript) = committed();
    let mut commands = transcript
        .lines()
        .filter_map(|line| line.strip_prefix(PROMPT));
    let (mut instructions, mut output, mut sent, mut executed) = (vec![], vec![], 0, 0_u64);
    // The ROMs of the boards have different programs that jump to the firmware; this board's program has two instructions.
    emulated.run(2);
    while verilated.cycles() < cycles {
        verilated.run(SLICE);
        verilated.uart_read(&mut output);
        if output.ends_with(PROMPT.as_bytes()) {
            output.clear();
            let command = commands.next().expect("commands for all cycles");
            verilated.uart_write(format!("{command}\r").as_bytes());
            sent += 1;
        }
        verilated.take_instructions(&mut instructions);
        for Instruction {
            cycle,
            pc,
            register,
            value,
        } in instructions.drain(..)
        {
            if executed == 0 && pc != MAIN_RAM.base {
                continue;
            }
            let other = Executed {
                cycle,
                pc,
                register,
                value,
            };
            if let Err(difference) = emulated.follow(other) {
                panic!(
                    "cycle {cycle}, after {executed} instructions and {sent} commands: {difference}"
                );
            }
            executed += 1;
        }
    }
    println!("{executed} instructions in {cycles} cycles, {sent} commands");
    assert!(executed > cycles / 10);
}
