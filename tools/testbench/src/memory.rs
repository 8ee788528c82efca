//! Model of the memory behind LiteDRAM's native ports, addressed in words of 16 bytes.

use std::collections::VecDeque;

use crate::{Bits, Module, Port, Stalls};

/// Contents of the memory, in words of 16 bytes. Methods panic for addresses beyond the memory.
pub struct Memory {
    words: Vec<[u8; 16]>,
}

impl Memory {
    /// Creates a memory of `words` words; each byte is 0xa5.
    #[must_use]
    pub fn new(words: usize) -> Self {
        Self {
            words: vec![[0xa5; 16]; words],
        }
    }

    /// Writes bytes from the start of word `address` on.
    pub fn write(&mut self, address: u32, bytes: &[u8]) {
        for (i, chunk) in bytes.chunks(16).enumerate() {
            self.words[address as usize + i][..chunk.len()].copy_from_slice(chunk);
        }
    }

    /// Returns word `address`.
    #[must_use]
    pub fn word(&self, address: u32) -> Bits {
        Bits::from_bytes(&self.words[address as usize])
    }

    /// Writes the bytes of `data` whose `strobe` bits are set to word `address`.
    pub fn store(&mut self, address: u32, data: Bits, strobe: u16) {
        for (i, byte) in self.words[address as usize].iter_mut().enumerate() {
            if strobe >> i & 1 == 1 {
                *byte = (data.words()[i / 4] >> (8 * (i % 4))) as u8;
            }
        }
    }

    /// Returns entry `index` of an array of 32-bit entries that starts at word `address`.
    #[must_use]
    pub fn entry(&self, address: u32, index: u32) -> u32 {
        self.word(address + index / 4)
            .element(32, index as usize % 4) as u32
    }
}

/// Default latency of a read port: clocks from a command to its data.
const LATENCY: u64 = 12;

/// The memory's side of a module's read port, which consists of the structs `NAME_read_request` and
/// `NAME_read_answer`. The module must take each word in the clock in which the memory delivers it.
pub struct ReadPort {
    cmd: [Port; 3],
    rdata: [Port; 2],
    /// Requested words that are not delivered yet: the earliest cycle of delivery, and the address.
    queue: VecDeque<(u64, u32)>,
    stalls: Stalls,
    /// Minimum number of clocks from a command to its data.
    pub latency: u64,
    /// Number of words delivered so far.
    pub given: u64,
}

impl ReadPort {
    /// Creates the memory's side of the port `name`.
    #[must_use]
    pub fn new(module: &Module, name: &str, stalls: Stalls) -> Self {
        let request = |member| module.port(&format!("{name}_read_request.{member}"));
        let answer = |member| module.port(&format!("{name}_read_answer.{member}"));
        Self {
            cmd: [
                request("cmd_valid"),
                answer("cmd_ready"),
                request("cmd_addr"),
            ],
            rdata: [answer("rdata_valid"), answer("rdata")],
            queue: VecDeque::new(),
            stalls,
            latency: LATENCY,
            given: 0,
        }
    }

    /// Drives the port for the next clock: delivers a word if a word is due, and accepts or stalls commands.
    pub fn drive(&mut self, module: &mut Module, memory: &Memory) {
        let stalled = self.stalls.next_stalled();
        module.set_value(self.cmd[1], u64::from(!stalled));
        let due = self
            .queue
            .front()
            .is_some_and(|&(cycle, _)| cycle <= module.cycles());
        let given = due && !self.stalls.next_stalled();
        module.set_value(self.rdata[0], u64::from(given));
        if given && let Some((_, address)) = self.queue.pop_front() {
            self.given += 1;
            module.set(self.rdata[1], memory.word(address));
        }
    }

    /// Takes the command of this clock, if any.
    pub fn sample(&mut self, module: &Module) {
        if module.is_high(self.cmd[0]) && module.is_high(self.cmd[1]) {
            let address = module.value(self.cmd[2]) as u32;
            self.queue
                .push_back((module.cycles() + self.latency, address));
        }
    }
}

/// The memory's side of a module's write port, which consists of the structs `NAME_write_request`
/// and `NAME_write_answer`. The memory takes a command's data in any later clock; the data must be
/// valid in that clock.
pub struct WritePort {
    cmd: [Port; 3],
    wdata: [Port; 4],
    /// Addresses of the commands whose data are not taken yet.
    owed: VecDeque<u32>,
    takes: bool,
    stalls: Stalls,
    /// Number of words written so far.
    pub written: u64,
}

impl WritePort {
    /// Creates the memory's side of the port `name`.
    #[must_use]
    pub fn new(module: &Module, name: &str, stalls: Stalls) -> Self {
        let request = |member| module.port(&format!("{name}_write_request.{member}"));
        let answer = |member| module.port(&format!("{name}_write_answer.{member}"));
        Self {
            cmd: [
                request("cmd_valid"),
                answer("cmd_ready"),
                request("cmd_addr"),
            ],
            wdata: [
                request("wdata_valid"),
                answer("wdata_ready"),
                request("wdata"),
                request("wdata_strobe"),
            ],
            owed: VecDeque::new(),
            takes: false,
            stalls,
            written: 0,
        }
    }

    /// Drives the port for the next clock: accepts or stalls commands, and data of earlier commands.
    pub fn drive(&mut self, module: &mut Module) {
        let stalled = self.stalls.next_stalled();
        module.set_value(self.cmd[1], u64::from(!stalled));
        self.takes = !self.owed.is_empty() && !self.stalls.next_stalled();
        module.set_value(self.wdata[1], u64::from(self.takes));
    }

    /// Takes the command of this clock, if any, and writes its data to `memory` if `drive` accepted data for this clock.
    ///
    /// # Panics
    /// When the data of a command are missing, or the address is beyond the memory.
    pub fn sample(&mut self, module: &Module, memory: &mut Memory) {
        if self.takes
            && let Some(address) = self.owed.pop_front()
        {
            let cycle = module.cycles();
            assert!(
                module.is_high(self.wdata[0]),
                "no data for a command in cycle {cycle}"
            );
            let (data, strobe) = (module.get(self.wdata[2]), module.value(self.wdata[3]));
            memory.store(address, data, strobe as u16);
            self.written += 1;
        }
        if module.is_high(self.cmd[0]) && module.is_high(self.cmd[1]) {
            self.owed.push_back(module.value(self.cmd[2]) as u32);
        }
    }
}
