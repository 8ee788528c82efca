//! Decoded instructions: each instruction is decoded once and executed many times.

/// Operation of an instruction. The names are those of the RISC-V specification.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Operation {
    /// Not decoded yet.
    Unknown,
    /// Not an instruction of this CPU.
    Illegal,
    Lui,
    Auipc,
    Jal,
    Jalr,
    Beq,
    Bne,
    Blt,
    Bge,
    Bltu,
    Bgeu,
    Lb,
    Lh,
    Lw,
    Lbu,
    Lhu,
    Sb,
    Sh,
    Sw,
    Addi,
    Slti,
    Sltiu,
    Xori,
    Ori,
    Andi,
    Slli,
    Srli,
    Srai,
    Add,
    Sub,
    Sll,
    Slt,
    Sltu,
    Xor,
    Srl,
    Sra,
    Or,
    And,
    Mul,
    Mulh,
    Mulhsu,
    Mulhu,
    Div,
    Divu,
    Rem,
    Remu,
    /// `fence`, and the flush of the data cache; both have no effect, because the emulated cache is always coherent.
    Fence,
    FenceI,
    Ecall,
    Mret,
    Wfi,
    Csr,
}

/// Index in the register file to which the results for register 0 are written.
pub const NOWHERE: u8 = 32;

/// A decoded instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction {
    /// Operation of the instruction.
    pub operation: Operation,
    /// Register of the result; [`NOWHERE`] for register 0.
    pub rd: u8,
    /// Register of the first operand.
    pub rs1: u8,
    /// Register of the second operand.
    pub rs2: u8,
    /// Immediate value, sign-extended; for [`Operation::Csr`] and [`Operation::Illegal`] the instruction word.
    pub immediate: u32,
}

impl Instruction {
    /// An instruction that is not decoded yet.
    pub const UNKNOWN: Self = Self {
        operation: Operation::Unknown,
        rd: NOWHERE,
        rs1: 0,
        rs2: 0,
        immediate: 0,
    };

    /// Decodes an instruction word. Every word that VexRiscv `full` executes is a legal instruction here: VexRiscv ignores some bits that
    /// the specification requires to be 0.
    pub fn decode(word: u32) -> Self {
        use Operation::*;
        let field = |low: u32, bits: u32| word >> low & ((1 << bits) - 1);
        let (rd, kind, rs1, rs2, high) = (
            field(7, 5) as u8,
            field(12, 3),
            field(15, 5) as u8,
            field(20, 5) as u8,
            field(25, 7),
        );
        let i = (word as i32 >> 20) as u32;
        let s = (word as i32 >> 20) as u32 & !0x1f | field(7, 5);
        let b = (word as i32 >> 31) as u32 & 0xffff_f000
            | field(7, 1) << 11
            | field(25, 6) << 5
            | field(8, 4) << 1;
        let u = word & 0xffff_f000;
        let j = (word as i32 >> 31) as u32 & 0xfff0_0000
            | word & 0x000f_f000
            | field(20, 1) << 11
            | field(21, 10) << 1;
        let (operation, immediate) = match (field(0, 7), kind) {
            (0x37, _) => (Lui, u),
            (0x17, _) => (Auipc, u),
            (0x6f, _) => (Jal, j),
            (0x67, 0) => (Jalr, i),
            (0x63, 0) => (Beq, b),
            (0x63, 1) => (Bne, b),
            (0x63, 4) => (Blt, b),
            (0x63, 5) => (Bge, b),
            (0x63, 6) => (Bltu, b),
            (0x63, 7) => (Bgeu, b),
            (0x03, 0) => (Lb, i),
            (0x03, 1) => (Lh, i),
            (0x03, 2 | 6) => (Lw, i),
            (0x03, 4) => (Lbu, i),
            (0x03, 5) => (Lhu, i),
            (0x23, 0) => (Sb, s),
            (0x23, 1) => (Sh, s),
            (0x23, 2) => (Sw, s),
            (0x13, 0) => (Addi, i),
            (0x13, 2) => (Slti, i),
            (0x13, 3) => (Sltiu, i),
            (0x13, 4) => (Xori, i),
            (0x13, 6) => (Ori, i),
            (0x13, 7) => (Andi, i),
            (0x13, 1) if high & 0x7e == 0 => (Slli, rs2.into()),
            (0x13, 5) if high & 0x7e == 0 => (Srli, rs2.into()),
            (0x13, 5) if high & 0x7e == 0x20 => (Srai, rs2.into()),
            (0x33, _) if high & 0x7e == 0 || high == 0x20 => {
                let operation = match (high, kind) {
                    (0, 0) => Add,
                    (0, 1) => Sll,
                    (0, 2) => Slt,
                    (0, 3) => Sltu,
                    (0, 4) => Xor,
                    (0, 5) => Srl,
                    (0, 6) => Or,
                    (0, _) => And,
                    (1, 0) => Mul,
                    (1, 1) => Mulh,
                    (1, 2) => Mulhsu,
                    (1, 3) => Mulhu,
                    (1, 4) => Div,
                    (1, 5) => Divu,
                    (1, 6) => Rem,
                    (1, _) => Remu,
                    (_, 0) => Sub,
                    (_, 5) => Sra,
                    _ => Illegal,
                };
                (operation, word)
            }
            (0x0f, 0) => (Fence, 0),
            (0x0f, 1) => (FenceI, 0),
            (0x0f, 5) if rs2 == 0 => (Fence, 0),
            (0x73, 0) => match word {
                0x0000_0073 => (Ecall, word),
                0x1050_0073 => (Wfi, 0),
                0x3020_0073 => (Mret, 0),
                _ => (Illegal, word),
            },
            (0x73, 1..=3 | 5..=7) => (Csr, word),
            _ => (Illegal, word),
        };
        Self {
            operation,
            rd: if rd == 0 { NOWHERE } else { rd },
            rs1,
            rs2,
            immediate,
        }
    }
}
