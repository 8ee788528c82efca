//! `glint board`.

use super::common::{LineArguments, Unsynchronised, bad_value};
use super::messages::{note, say, warn};
use super::output::{Output, PICTURE};
use super::progress::{show_simulation, spinner};
use super::terminal::{print_output, talk};
use anyhow::Context;
use clap::Args;
use glint::board::{self, AnyBoard, Board, BoardName, MonitorFrame};
use glint::console::{BIOS_PROMPT, plain};
use glint::error::quote;
use glint::formats::read_up_to;
use glint::web::{Server, Watched, read_program};
use glint_board_api::pace::SystemClock;
use glint_core::colour::Rgb565;
use glint_core::console::PROMPT;
use glint_live_page::{Live, LiveSimulation, Places};
use glint_texture::picture::Picture;
use rustix::termios::isatty;
use std::net::SocketAddr;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::time::Duration;
use virtual_board::pty::Pty;
use virtual_board::virtual_flash::{Flash, MAX_BYTES};

/// Time-out of a read from the board with `--seconds`, in milliseconds of the board's time.
const POLL_MS: u64 = 10;
/// Ends of the prompts of the firmware and of the BIOS.
const PROMPTS: [&[u8]; 2] = [PROMPT.as_bytes(), BIOS_PROMPT];

/// Run a board until Ctrl-C, for programs or in a web page: print its serial port or the page's address.
///
/// With `--board PORT --firmware FILE`, the BIOS of a board on a serial port loads the program; its console opens, or with --web the page.
///
/// Without --web, any program that uses serial ports can open the port, one program at a time: `glint … --board PORT`,
/// litex_term, a script. Several boards run side by side. On a terminal without --pty and --ready-file, the board's console opens
/// at once; Ctrl-] ends it and the board.
#[derive(Args)]
pub struct BoardArguments {
    /// Create this symbolic link to the port, and remove it at the end. An existing link to a
    /// pseudo-terminal, which a killed board leaves behind, is replaced.
    #[arg(long, value_name = "LINK")]
    pty: Option<PathBuf>,
    /// Write the port's path or the page's address to this file when the board is ready, and remove
    /// the file at the end. An existing file is removed at the start.
    #[arg(long, value_name = "FILE")]
    ready_file: Option<PathBuf>,
    /// Start with the BIOS, which waits for a program, like a board without a program in its flash memory.
    #[arg(long, conflicts_with = "firmware")]
    bios: bool,
    /// Start with the BIOS and this image in the flash memory (`glint image make`), like a board at power-up.
    #[arg(long, value_name = "IMAGE", conflicts_with = "firmware")]
    flash: Option<PathBuf>,
    /// Serve the live page at this address instead of a serial port: a web page with the board's monitor, console, buttons,
    /// switches, LEDs and digits; port 0 selects a free port. The printed address opens the page [default: 127.0.0.1:0].
    #[arg(long, value_name = "ADDR", num_args = 0..=1, default_missing_value = "127.0.0.1:0", conflicts_with_all = ["pty", "bios", "flash"])]
    web: Option<SocketAddr>,
    /// With --web, start or load the firmware again whenever its file changes, such as after `cargo build`.
    #[arg(long, requires = "web", requires = "firmware")]
    watch: bool,
    /// Serve GDB at this address: `target remote ADDR` in gdb-multiarch stops the board, for breakpoints, steps, registers and memory.
    /// Only for the emulated board; port 0 selects a free port [default: 127.0.0.1:3333].
    #[arg(long, value_name = "ADDR", num_args = 0..=1, default_missing_value = "127.0.0.1:3333", conflicts_with_all = ["bios", "flash"])]
    gdb: Option<SocketAddr>,
    /// Run a simulated board for this time, print the output of its program, and end; takes the place of --web and --watch before it.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, overrides_with_all = ["web", "watch"], conflicts_with_all = ["pty", "ready_file", "gdb"])]
    seconds: Option<Duration>,
    /// With --seconds, hold these of the buttons 0 to 3 down, such as `0,2`.
    #[arg(long, value_name = "BUTTONS", value_delimiter = ',', value_parser = clap::value_parser!(u8).range(0..4), requires = "seconds")]
    hold: Vec<u8>,
    /// With --seconds, write the picture on the monitor at the end.
    #[arg(long, value_name = "PICTURE.png", requires = "seconds")]
    picture: Option<PathBuf>,
    /// Board: `emulated`, or `virtual` (the verilated SoC), which is slow; with --web or --firmware also a serial port.
    #[arg(long, default_value = "emulated")]
    board: BoardName,
    #[command(flatten)]
    line: LineArguments,
}

impl BoardArguments {
    pub fn run(self) -> anyhow::Result<()> {
        self.line.baud.check(&self.board)?;
        if self.gdb.is_some() && self.board != BoardName::Emulated {
            let found = quote(self.board.to_string().as_bytes());
            return Err(bad_value("--board with --gdb", "emulated", found).into());
        }
        if let Some(address) = self.web {
            return self.serve(address);
        }
        match (&self.board, self.seconds) {
            (BoardName::Serial(port), _) => self.run_on(port),
            (_, Some(time)) => self.run_for(time),
            (_, None) => self.stay(),
        }
    }

    /// Opens the file of `--ready-file`.
    fn ready(&self) -> anyhow::Result<Option<Ready>> {
        self.ready_file.as_deref().map(Ready::open).transpose()
    }

    /// Serves the live page.
    fn serve(&self, address: SocketAddr) -> anyhow::Result<()> {
        let ready = self.ready()?;
        let watched = self.line.firmware.clone().filter(|_| self.watch);
        let watched = watched.map(Watched::new);
        // A simulated board starts with its program.
        let first = self.line.firmware.as_deref();
        let first = first.filter(|_| !self.board.is_simulated());
        let first = first.map(read_program).transpose()?;
        let server = Server::bind(address).with_context(|| format!("--web {address}"))?;
        let mut board: Box<dyn Live> = match &self.board {
            // The page finds the board's firmware, or loads it.
            BoardName::Serial(port) => Box::new(self.line.open(port)?),
            simulated => {
                let period = match simulated {
                    BoardName::Virtual => Duration::from_secs(2),
                    _ => Duration::from_millis(250),
                };
                let (board, places) = self.start()?;
                let clock = SystemClock::start();
                Box::new(LiveSimulation::new(board, places, period, clock))
            }
        };
        // Before this line a signal ends the program at once.
        let stop = Arc::new(AtomicBool::new(false));
        let ended = Arc::clone(&stop);
        ctrlc::set_handler(move || ended.store(true, Ordering::Relaxed))?;
        let url = server.url()?;
        say(&url)?;
        if address.ip().is_unspecified() {
            note("on other devices, replace the host in this address by this machine's address");
        }
        let _ready = ready.map(|ready| ready.write(&url)).transpose()?;
        let name = self.board.to_string();
        Ok(server.run(&mut *board, &name, first, watched, &stop)?)
    }

    /// Loads the program onto a board on a serial port, and opens its console, or without a terminal prints its output, until Ctrl-C.
    fn run_on(&self, port: &str) -> anyhow::Result<()> {
        for (is_given, option) in [
            (self.pty.is_some(), "--pty"),
            (self.ready_file.is_some(), "--ready-file"),
            (self.bios, "--bios"),
            (self.flash.is_some(), "--flash"),
            (self.seconds.is_some(), "--seconds"),
        ] {
            if is_given {
                let found = quote(port.as_bytes());
                return Err(bad_value(
                    &format!("--board with {option}"),
                    "emulated or virtual",
                    found,
                )
                .into());
            }
        }
        if self.line.firmware.is_none() {
            let expected = "emulated or virtual, or --web or --firmware";
            return Err(bad_value("--board", expected, quote(port.as_bytes())).into());
        }
        let mut opened = self.line.loaded(port)?;
        if isatty(std::io::stdin()) {
            return talk(&mut opened, || false);
        }
        print_output(opened)
    }

    /// Starts the board with its program, and with `--gdb` for a debugger.
    fn start(&self) -> anyhow::Result<(AnyBoard, Places)> {
        let Some(address) = self.gdb else {
            return self.line.start(&self.board);
        };
        self.line.start_by(|image| {
            let mut board = board::debugged(image, address)?;
            let address = board.inner().address()?;
            note(format_args!("GDB: target remote {address}"));
            Ok(board.into())
        })
    }

    /// Whether the board starts with the BIOS.
    fn has_bios(&self) -> bool {
        self.bios || self.flash.is_some()
    }

    /// Builds the simulated board in its state at power-up.
    fn simulated(&self) -> anyhow::Result<(AnyBoard, Places)> {
        if !self.has_bios() {
            return self.start();
        }
        let board = board::simulated(&self.board, None)?;
        let mut board = board.context("expected a simulated board")?;
        if let Some(path) = &self.flash {
            let image = read_up_to(path, MAX_BYTES)?;
            board.inner().plug_flash(Flash::new(image));
        }
        show_simulation(board.meter());
        Ok((board, Places::default()))
    }

    /// Runs a simulated board for a time.
    fn run_for(&self, time: Duration) -> anyhow::Result<()> {
        let inputs = self.line.firmware.iter().chain(&self.flash);
        let picture = self.picture.as_deref();
        let picture = picture.map(|path| Output::open(path, PICTURE, inputs));
        let picture = picture.transpose()?;
        let (mut board, mut places) = self.simulated()?;
        let held = self.hold.iter().fold(0, |held, button| held | 1 << button);
        board.inner().set_buttons(held);
        if picture.is_some() {
            // Turns the monitor on.
            board.inner().new_frame(0)?;
        }
        let end_ms = board.now_ms() + time.as_millis() as u64;
        let mut line = Vec::new();
        while board.now_ms() < end_ms {
            let before = line.len();
            board.read(&mut line, POLL_MS.min(end_ms - board.now_ms()))?;
            let said = line.split_off(before);
            for part in said.split_inclusive(|&byte| byte == b'\n') {
                line.extend(part);
                if part.ends_with(b"\n") {
                    say(plain(&line).trim_end())?;
                    line.clear();
                }
            }
            places.hear(&said).into_iter().for_each(note);
        }
        if !line.is_empty() {
            say(plain(&line))?;
        }
        let Some(output) = picture else {
            return Ok(());
        };
        let (_, frame) = (board.inner().new_frame(0)?)
            .context("--picture: expected a picture on the monitor within the time of --seconds")?;
        let png = encoded(&frame)?;
        output.write(|out| out.write_all(&png))
    }

    fn stay(&self) -> anyhow::Result<()> {
        let ready = self.ready()?;
        // Before this line a signal ends the program at once, also while the program waits for a
        // pipe.
        let (board, mut places) = self.simulated()?;
        let (report, events) = channel();
        let end = report.clone();
        ctrlc::set_handler(move || {
            // Without a receiver the program is already ending.
            let _ = end.send(Event::End);
        })?;
        let mut first_prompt = first_prompt(report);
        let pty = Pty::watched(board, move |_: &[u8], said: &[u8]| {
            first_prompt(said);
            places.hear(said).into_iter().for_each(note);
        })?;
        let port = pty.path();
        let link = self.pty.as_deref().map(|link| Link::new(link, port));
        let _link = link.transpose()?;
        say(port.display())?;
        let ready = ready.map(|ready| ready.write(&port.display().to_string()));
        let _ready = ready.transpose()?;
        if self.pty.is_none() && self.ready_file.is_none() && isatty(std::io::stdin()) {
            let port = port.to_string_lossy();
            let is_ended = || events.try_iter().any(|event| matches!(event, Event::End));
            let mut opened = Unsynchronised {
                board: self.line.open(&port)?,
                // The watcher of the port prints them.
                places: Places::default(),
                said: None,
            };
            return talk(&mut opened, is_ended);
        }
        // A prompt ends the spinner, and a firmware need not print one, so only a start with the
        // BIOS has a spinner.
        let mut starting = self.has_bios().then(|| spinner("the board starts"));
        while let Event::Started = events.recv()? {
            starting = None;
        }
        drop(starting);
        Ok(())
    }
}

/// Parses a time in seconds, of at most a day.
fn seconds(text: &str) -> Result<Duration, &'static str> {
    let number = text.parse().ok().filter(|number| *number <= 86_400.0);
    let time = number.and_then(|number| Duration::try_from_secs_f64(number).ok());
    time.ok_or("expected a number from 0 to 86400")
}

/// A frame on a monitor as a PNG file.
fn encoded(frame: &MonitorFrame) -> anyhow::Result<Vec<u8>> {
    let size = [frame.width, frame.height].map(|side| side as u32);
    let picture = Picture::drawn(size, |x, y| {
        let [r, g, b] = Rgb565(frame.pixels[y as usize * frame.width + x as usize]).to_rgb888();
        [r, g, b, 255]
    });
    Ok(picture.png()?)
}

/// Events that `glint board` waits for.
enum Event {
    /// The first prompt.
    Started,
    /// Ctrl-C, or another signal that ends the program.
    End,
}

/// Returns a callback that reports the first prompt in the output of a board.
fn first_prompt(report: Sender<Event>) -> impl FnMut(&[u8]) + Send {
    let longest = PROMPTS.map(<[u8]>::len).into_iter().max().unwrap_or(0);
    // The end of the output, which may be the start of a prompt, and the sender, which is taken
    // when the event is sent.
    let (mut heard, mut report) = (Vec::new(), Some(report));
    move |said| {
        if said.is_empty() || report.is_none() {
            return;
        }
        heard.extend_from_slice(said);
        let is_said = |prompt: &&[u8]| heard.windows(prompt.len()).any(|part| part == *prompt);
        if PROMPTS.iter().any(is_said)
            && let Some(report) = report.take()
        {
            // Without a receiver the program is already ending.
            let _ = report.send(Event::Started);
        }
        heard.drain(..heard.len().saturating_sub(longest));
    }
}

/// The file of `--ready-file`, which exists only while the board runs.
struct Ready(Output);

impl Ready {
    /// Removes an existing file, and checks that the file can be written.
    fn open(path: &Path) -> anyhow::Result<Self> {
        if path.is_file() {
            std::fs::remove_file(path).with_context(|| path.display().to_string())?;
        }
        Ok(Self(Output::open(path, &[], [""; 0])?))
    }

    /// Writes the file. The result removes it when it is dropped, unless it is a device or a pipe.
    fn write(self, text: &str) -> anyhow::Result<Removal> {
        let path = self.0.path().to_owned();
        self.0.write(|out| writeln!(out, "{text}"))?;
        let removed = path.is_file().then_some(path);
        Ok(Removal(removed))
    }
}

/// A file or a link that is removed when the value is dropped.
struct Removal(Option<PathBuf>);

impl Drop for Removal {
    fn drop(&mut self) {
        if let Some(path) = &self.0
            && let Err(error) = std::fs::remove_file(path)
        {
            warn(format_args!(
                "{}: cannot be removed: {error}",
                path.display()
            ));
        }
    }
}

/// A symbolic link to a port, which is removed when the value is dropped, unless another program has replaced it.
struct Link {
    link: PathBuf,
    port: PathBuf,
}

/// The folder of pseudo-terminals.
const TERMINALS: &str = "/dev/pts";

impl Link {
    fn new(link: &Path, port: &Path) -> anyhow::Result<Self> {
        let cannot = || format!("{}: cannot be linked to {}", link.display(), port.display());
        if let Ok(present) = link.symlink_metadata() {
            let target = std::fs::read_link(link).ok();
            if !target
                .as_ref()
                .is_some_and(|target| target.starts_with(TERMINALS))
            {
                let found = match target {
                    Some(target) => format!("a link to {}", target.display()),
                    None if present.is_dir() => "a folder".to_owned(),
                    None => "a file".to_owned(),
                };
                let expected = "a new name, or a link to a pseudo-terminal";
                return Err(bad_value(&link.display().to_string(), expected, found).into());
            }
            std::fs::remove_file(link).with_context(cannot)?;
        }
        symlink(port, link).with_context(cannot)?;
        Ok(Self {
            link: link.to_owned(),
            port: port.to_owned(),
        })
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        let target = std::fs::read_link(&self.link);
        let is_own = target.is_ok_and(|target| target == self.port);
        drop(Removal(is_own.then(|| self.link.clone())));
    }
}
