//! Compares the speeds of the virtual board and of the bare model: [`VirtualBoard::run`] with the monitor off and on,
//! and a C++ loop that only advances the clocks, in cycles per second. Measurements of the three kinds alternate.
//!
//! `cargo run -p virtual-board --example simulation_speed`
//!
//! Exit code 1 if the board with its monitor off is below 90 % of the bare loop's speed.

use std::process::ExitCode;
use std::time::Instant;
use virtual_board::Uart;

use virtual_board::{Error, VirtualBoard};

/// Number of cycles of one measurement.
const TURN: u64 = 100_000;
/// Number of measurements of each kind. The example prints their median, which pauses of the host
/// do not affect.
const TURNS: usize = 15;

fn main() -> Result<ExitCode, Error> {
    let turns: [fn(&mut VirtualBoard); 3] = [
        |board| board.run_bare(TURN),
        |board| board.run(TURN),
        |board| board.run(TURN),
    ];
    let mut boards = Vec::new();
    for monitor in [false, false, true] {
        let start = Instant::now();
        let mut board = VirtualBoard::builder().build()?;
        eprintln!("created a board in {:.3} s", start.elapsed().as_secs_f64());
        if monitor {
            board.monitor().turn_on();
        }
        // All boards begin the measurements at the same cycle of the same program.
        board.run(TURN);
        boards.push(board);
    }
    let mut seconds = [const { Vec::new() }; 3];
    for _ in 0..TURNS {
        for ((board, turn), seconds) in boards.iter_mut().zip(turns).zip(&mut seconds) {
            let start = Instant::now();
            turn(board);
            seconds.push(start.elapsed().as_secs_f64());
        }
    }
    let [bare, run, watched] = seconds.map(|mut seconds| {
        seconds.sort_by(f64::total_cmp);
        TURN as f64 / seconds[TURNS / 2]
    });
    println!("bare C++ loop     {bare:9.0} cycles/s");
    println!(
        "board             {run:9.0} cycles/s  {:5.1} %",
        100.0 * run / bare
    );
    println!(
        "board and monitor {watched:9.0} cycles/s  {:5.1} %",
        100.0 * watched / bare
    );
    Ok(if run >= 0.9 * bare {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}
