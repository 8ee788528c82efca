//! Tests of scan-out in the whole SoC with the monitor: all scales, a flip to another frame, and memory traffic of the CPU.

use crate::program;
use litex_pac::{leds, scanout};
use virtual_board::Simulation;
use virtual_board::{HEIGHT, WIDTH};

/// Addresses of two frame buffers, far enough apart for the largest frame.
const FRAME: u32 = 0x4100_0000;
const OTHER_FRAME: u32 = 0x4120_0000;

/// Address of the program's parameters.
const PARAMETERS: u32 = 0x4010_0000;

/// Address from which the program reads and writes memory during scan-out.
const TRAFFIC: u32 = 0x4080_0000;

/// Makes a frame of `pixels` pixels of pseudo-random colours.
fn frame(pixels: usize, seed: u32) -> Vec<u16> {
    (0..pixels as u32)
        .map(|i| (i.wrapping_add(seed).wrapping_mul(0x9e37_79b1) >> 13) as u16)
        .collect()
}

fn bytes(frame: &[u16]) -> Vec<u8> {
    frame.iter().flat_map(|pixel| pixel.to_le_bytes()).collect()
}

/// Shows a frame, requests a flip to a second frame, and checks that the monitor shows the first frame, then the second frame for the rest
/// of `frames` video frames.
fn shows_and_flips(scale: usize, frames: u64) {
    // SAFETY: only computes addresses of registers, without an access.
    let (scanout, leds) = unsafe { (scanout::Scanout::steal(), leds::Leds::steal()) };
    let base = scanout::Scanout::BASE;
    let mut board = program::started(
        "scan_out",
        &[
            ("SCANOUT", base as u32),
            ("CONTROL", (scanout.control().address() - base) as u32),
            ("FB_NEXT", (scanout.fb_next().address() - base) as u32),
            ("SCALE", (scanout.scale().address() - base) as u32),
            ("FB_CURRENT", (scanout.fb_current().address() - base) as u32),
            (
                "UNDERFLOW_COUNT",
                (scanout.underflow_count().address() - base) as u32,
            ),
            ("LEDS_OUT", leds.out().address() as u32),
            ("FRAME", FRAME),
            ("PARAMETERS", PARAMETERS),
            ("TRAFFIC", TRAFFIC),
        ],
    );
    let pixels = WIDTH * HEIGHT / (scale * scale);
    let (first, second) = (frame(pixels, 1), frame(pixels, 1 << 20));
    for (address, data) in [
        (FRAME, bytes(&first)),
        (OTHER_FRAME, bytes(&second)),
        (PARAMETERS, (scale as u32).to_le_bytes().to_vec()),
        (PARAMETERS + 4, OTHER_FRAME.to_le_bytes().to_vec()),
    ] {
        board.ddr_write(address, &data).expect("main RAM");
    }

    board.monitor().turn_on();
    for number in 0..frames {
        let shown = board
            .capture()
            .expect("a frame")
            .scaled_back(scale)
            .expect("an enlarged frame");
        let expected = if number == 0 { &first } else { &second };
        assert!(shown == *expected, "frame {number} at scale {scale}");
    }
    assert_eq!(board.monitor().frames(), frames);
    assert_eq!(board.monitor().errors(), [], "timing at scale {scale}");
    assert_eq!(board.leds(), 0, "underflows at scale {scale}");
}

#[test]
fn scale_4() {
    shows_and_flips(4, 2);
}

#[test]
fn scale_2() {
    shows_and_flips(2, 2);
}

#[test]
fn scale_1() {
    shows_and_flips(1, 3);
}
