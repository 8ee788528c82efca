//! The blocks of the SoC, each with its register window.

mod i2c;
mod pins;
mod scanout;
mod system;
mod timer;
mod uart;

use glint_core::block::Block;
use litex_pac::{
    Interrupt, Memory, buttons, ctrl, digits, gesture as gesture_block, identity, leds,
    raymarch as raymarch_block, scanout as scanout_block, switches, timer0,
    triangle as triangle_block, uart as uart_block,
};

use crate::{Device, GestureEngine, MainMemory, TriangleEngine};
use i2c::I2c;
use pins::{Digits, Inputs, Outputs};
use scanout::Scanout;
use system::{Controller, Identity};
use timer::Timer;
use uart::Uart;

/// Addresses of all registers.
pub const REGISTERS: Memory = Memory {
    base: ctrl::Ctrl::BASE as u32,
    size: 0x1_0000,
};

/// Size of a block's window in bytes: the difference between the addresses of the first two windows.
const WINDOW: u32 = (identity::Identity::BASE - ctrl::Ctrl::BASE) as u32;

/// First address and interrupt of each block, in the order of [`Devices::device`]. A window without a block reads as 0.
const BLOCKS: [(usize, Option<Interrupt>); 13] = [
    (ctrl::Ctrl::BASE, None),
    (identity::Identity::BASE, None),
    (uart_block::Uart::BASE, Some(Interrupt::Uart)),
    (timer0::Timer0::BASE, Some(Interrupt::Timer0)),
    (litex_pac::i2c::I2c::BASE, Some(Interrupt::I2c)),
    (buttons::Buttons::BASE, Some(Interrupt::Buttons)),
    (switches::Switches::BASE, None),
    (leds::Leds::BASE, None),
    (scanout_block::Scanout::BASE, Some(Interrupt::Scanout)),
    (triangle_block::Triangle::BASE, Some(Interrupt::Triangle)),
    (raymarch_block::Raymarch::BASE, Some(Interrupt::Raymarch)),
    (gesture_block::Gesture::BASE, Some(Interrupt::Gesture)),
    (digits::Digits::BASE, None),
];

/// Index in `BLOCKS` of the block in each window, if any.
const NUMBERS: [Option<u8>; (REGISTERS.size / WINDOW) as usize] = {
    let mut numbers = [None; (REGISTERS.size / WINDOW) as usize];
    let mut number = 0;
    while number < BLOCKS.len() {
        let window = (BLOCKS[number].0 as u32 - REGISTERS.base) / WINDOW;
        numbers[window as usize] = Some(number as u8);
        number += 1;
    }
    numbers
};

/// Index of the triangle engine in `BLOCKS`.
const TRIANGLE: usize = 9;
/// Index of the raymarcher in `BLOCKS`.
const RAYMARCH: usize = 10;

/// The blocks of the SoC.
pub struct Devices {
    /// Reset and bus errors.
    pub controller: Controller,
    /// Build id and blocks.
    pub identity: Identity,
    pub uart: Uart,
    timer: Timer,
    /// The I2C master with its sensor.
    pub i2c: I2c,
    pub buttons: Inputs,
    pub switches: Inputs,
    pub leds: Outputs,
    pub scanout: Scanout,
    /// The triangle engine with the raymarcher.
    pub triangle: TriangleEngine,
    /// The gesture engine with its image sensor.
    pub gesture: GestureEngine,
    /// The seven-segment displays.
    pub digits: Digits,
    /// Cycle of the next event of each block.
    next: [u64; BLOCKS.len()],
    /// The smallest element of `next`.
    first: u64,
    /// Levels of the interrupt lines.
    lines: u32,
}

impl Devices {
    /// The blocks after the start of the board.
    pub fn new() -> Self {
        Self {
            controller: Controller::new(),
            identity: Identity {
                blocks: Block::ALL.iter().fold(0, |bits, block| bits | block.bit()),
            },
            uart: Uart::new(),
            timer: Timer::new(),
            i2c: I2c::new(),
            buttons: Inputs::new(4, true),
            switches: Inputs::new(16, false),
            leds: Outputs::default(),
            scanout: Scanout::new(),
            triangle: TriangleEngine::new(),
            gesture: GestureEngine::new(),
            digits: Digits::default(),
            // Each block returns its next event at the first call of `advance`.
            next: [0; BLOCKS.len()],
            first: 0,
            lines: 0,
        }
    }

    /// Resets the blocks at the CPU's request; the input pins, the digits and the video timing keep their state.
    pub fn reset(&mut self) {
        self.controller = Controller::new();
        self.uart.reset();
        self.timer = Timer::new();
        self.i2c.reset();
        self.buttons.reset();
        self.leds = Outputs::default();
        self.scanout.reset();
        self.triangle.reset();
        self.gesture.reset();
        (self.next, self.first) = ([0; BLOCKS.len()], 0);
    }

    fn device(&mut self, number: usize) -> &mut dyn Device {
        match number {
            0 => &mut self.controller,
            1 => &mut self.identity,
            2 => &mut self.uart,
            3 => &mut self.timer,
            4 => &mut self.i2c,
            5 => &mut self.buttons,
            6 => &mut self.switches,
            7 => &mut self.leds,
            8 => &mut self.scanout,
            TRIANGLE => &mut self.triangle,
            RAYMARCH => &mut self.triangle.raymarcher,
            11 => &mut self.gesture,
            _ => &mut self.digits,
        }
    }

    /// The block at byte `offset` of the register region, and the offset of the register in the block.
    fn find(offset: u32) -> Option<(usize, u32)> {
        let number = NUMBERS[(offset / WINDOW) as usize]?;
        Some((number.into(), offset % WINDOW))
    }

    fn update(&mut self, number: usize, now: u64, ram: &mut MainMemory) {
        let next = self.device(number).advance(now, ram);
        let last = std::mem::replace(&mut self.next[number], next);
        // Most updates keep a block's next event, and a program that polls a register makes many of them.
        if next < self.first {
            self.first = next;
        } else if last == self.first && next != last {
            self.first = self.next.into_iter().min().unwrap_or(u64::MAX);
        }
        self.update_line(number);
        if number == TRIANGLE {
            self.update_line(RAYMARCH);
        }
    }

    /// Reads the register at byte `offset` of the register region.
    pub fn read(&mut self, offset: u32, now: u64, ram: &mut MainMemory) -> u32 {
        let Some((number, register)) = Self::find(offset) else {
            return 0;
        };
        self.update(number, now, ram);
        let value = self.device(number).read(register, now);
        self.update(number, now, ram);
        value
    }

    /// Writes the register at byte `offset` of the register region.
    pub fn write(&mut self, offset: u32, value: u32, now: u64, ram: &mut MainMemory) {
        let Some((number, register)) = Self::find(offset) else {
            return;
        };
        self.update(number, now, ram);
        self.device(number).write(register, value, now, ram);
        self.update(number, now, ram);
    }

    /// Processes all events up to the cycle `now`; returns the cycle of the next event.
    pub fn advance(&mut self, now: u64, ram: &mut MainMemory) -> u64 {
        if self.first <= now {
            for number in 0..BLOCKS.len() {
                if self.next[number] <= now {
                    self.update(number, now, ram);
                }
            }
        }
        self.first
    }

    /// Processes events while the CPU sleeps, until an interrupt line changes or the cycle `end` is reached. Returns the cycle in which
    /// this happens.
    pub fn sleep(&mut self, end: u64, ram: &mut MainMemory) -> u64 {
        let lines = self.lines;
        loop {
            let (mut number, mut now, mut others) = (0, u64::MAX, end);
            for (at, &next) in self.next.iter().enumerate() {
                others = others.min(next.max(now));
                if next < now {
                    (number, now) = (at, next);
                }
            }
            if now >= end {
                return end;
            }
            // No other block has an event before the cycle `others`, so this block processes its events up to that cycle first.
            while now <= others {
                self.update(number, now, ram);
                if self.lines != lines {
                    return now;
                }
                now = self.next[number];
            }
        }
    }

    /// Levels of the interrupt lines.
    pub const fn interrupts(&self) -> u32 {
        self.lines
    }

    /// Updates all interrupt lines, because the host may have sent bytes to the UART or changed the levels of pins.
    pub fn update_lines(&mut self) {
        for number in 0..BLOCKS.len() {
            self.update_line(number);
        }
    }

    fn update_line(&mut self, number: usize) {
        if let Some(interrupt) = BLOCKS[number].1 {
            let line = u32::from(self.device(number).interrupt()) << interrupt as u32;
            self.lines = self.lines & !(1 << interrupt as u32) | line;
        }
    }
}
