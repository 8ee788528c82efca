//! Runs the board, its console and its transfers for the page.

use crate::channels::{Channels, MAX_REQUESTS, Program, Request, Upload};
use crate::choices::{Choices, List};
use crate::hub::Hub;
use crate::live::Live;
use crate::message::{Entry, Pins, ToPage};
use crate::orbit::{self, Drag};
use crate::scene::{File, Scene};
use glint_board_api::console::{self, Console, ConsoleError};
use glint_board_api::flash::{self, FlashError};
use glint_board_api::transfer::{self, MODEL, TransferError};
use glint_board_api::{Board, BoardError, Frame, Memory, read_in_steps};
use glint_core::camera::View;
use glint_core::console::{Command, PROMPT, Setting};
use glint_core::matrix::Axis;
use glint_core::picture::Size;
use glint_program_image::{Places, START_ADDRESS};
use serde_json::Value;
use std::collections::VecDeque;
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;
use std::time::Duration;

/// Interval at which the session polls the requests of the pages, in ms of the board's time.
const POLL_MS: u64 = 2;

/// The key Ctrl-C, which cancels the running command.
const INTERRUPT: &[u8] = b"\x03";

/// Time-out of the first prompt of a program on a simulated board, in ms of the board's time. After this time the program counts as one
/// without a prompt.
const FIRST_PATIENCE_MS: u64 = 1_000;

/// Longest wait for the BIOS's request for a serial boot, in ms of the board's time.
const BIOS_PATIENCE_MS: u64 = 60_000;

/// Time after the load of a program over a serial line within which its first prompt is expected, in ms of the board's time.
const LOADED_PATIENCE_MS: u64 = 10_000;

/// Notice about a request that only the firmware can execute.
const NO_FIRMWARE: &str =
    "expected the prompt of the firmware, found none: load the firmware first, then try again";

/// Advice for a board on a serial line that does not answer.
const NO_ANSWER: &str =
    "press the board's reset button, or drop a program, which the board's BIOS loads";

/// Notice about a transfer or a wait that a page has cancelled.
const STOPPED: &str = "stopped";

/// Note on a program without a prompt.
const NO_PROMPT: &str =
    "The program has no prompt, so the page has no lists of scenes, meshes and fields for it.";

/// Interval in ms of the board's time between two pictures of a moving field.
const FRAME_MS: u64 = 40;

/// Maximum number of progress reports of a transfer.
const REPORTS: u64 = 100;

/// A board whose picture and pin levels are sent to the pages while the serial line is read.
struct Watched<'a> {
    board: &'a mut dyn Live,
    channels: &'a Channels,
    stop: &'a AtomicBool,
    pins: Option<Pins>,
    /// Whether the pages may cancel what the session does now.
    may_cancel: bool,
}

impl Watched<'_> {
    /// Exchanges pin levels with the pages, and sends a new picture, if any.
    fn exchange(&mut self) -> Result<(), BoardError> {
        if self.stop.load(Ordering::Relaxed) {
            return Err(io::Error::from(io::ErrorKind::Interrupted).into());
        }
        if self.may_cancel && self.channels.take_cancelled() {
            return Err(BoardError::Cancelled);
        }
        let hub = &self.channels.hub;
        let pins = self.board.pins(self.channels.inputs.take());
        if pins != self.pins {
            self.pins = pins;
            pins.into_iter().for_each(|pins| hub.send_pins(pins));
        }
        if let Some(frame) = self.board.picture()? {
            hub.show(&frame);
        }
        Ok(())
    }

    /// Sets whether the pages may cancel what follows. An earlier cancellation is dropped.
    fn set_may_cancel(&mut self, may_cancel: bool) {
        self.channels.take_cancelled();
        self.may_cancel = may_cancel;
    }
}

impl Board for Watched<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        self.board.write(bytes)
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        read_in_steps(self, bytes, wait_ms, |watched, bytes, left| {
            watched.exchange()?;
            watched.board.read(bytes, left.min(POLL_MS))
        })
    }

    fn now_ms(&self) -> u64 {
        self.board.now_ms()
    }

    fn memory(&mut self) -> Option<&mut dyn Memory> {
        self.board.memory()
    }
}

/// Runs a board until `stop` is set. A board on a serial line may run its firmware or another program, be in its BIOS, or be silent.
///
/// # Errors
/// The line to the board has failed.
pub fn run(
    board: &mut dyn Live,
    channels: &Channels,
    requests: Receiver<Request>,
    stop: &AtomicBool,
) -> Result<(), BoardError> {
    let serve = || {
        let mut session = Session::start(board, channels, requests, stop)?;
        loop {
            session.step()?;
        }
    };
    match serve() {
        _ if stop.load(Ordering::Relaxed) => Ok(()),
        result => result,
    }
}

/// The wait for the first prompt of a program that has just started.
struct Meeting {
    /// End of the wait, in ms of the board's time; `u64::MAX` for a board that may be reset by hand at any time.
    end_ms: u64,
    /// Text for the pages; empty for the first program.
    started: String,
}

/// The session with a board; the board runs during the session's steps.
pub struct Session<'a> {
    board: Watched<'a>,
    hub: &'a Hub,
    requests: Receiver<Request>,
    /// Requests that are queued until the end of a command.
    waiting: VecDeque<Request>,
    /// The channel to the pages, with the choices of the firmware.
    channels: &'a Channels,
    /// The commands that show the pictures of a moving field; the first command is the next.
    frames: VecDeque<String>,
    /// Time of the last picture of a moving field, in ms of the board's time.
    moved_ms: u64,
    /// The camera after the last drag on a page, and its up direction; `None` after any other
    /// request.
    orbit: Option<(View, [f64; 3])>,
    /// Time of the last measurement on the board's clock.
    sampled: Duration,
    /// The up axis of the last uploaded mesh.
    up: Axis,
    /// Number of uploads, which distinguishes successive transfers.
    uploads: u8,
    /// Whether a prompt has been received. The session sends no commands of its own to a program
    /// without a prompt.
    has_prompt: bool,
    /// The source locations of the running program.
    places: Places,
    /// The wait for the first prompt of a program that has just started.
    meeting: Option<Meeting>,
    /// Time until which requests are kept for a program that has just started and has not sent its prompt, in ms of the board's time.
    kept_ms: u64,
    /// The last bytes of the console's output; empty after the session's own commands, because
    /// their replies end with the prompt.
    end: Vec<u8>,
}

impl<'a> Session<'a> {
    /// Begins the session with a board. On a serial line it may run its firmware or another program, be in its BIOS, or be silent: the
    /// firmware's lists are sent as soon as it prints its prompt. All calls fail once `stop` is set.
    ///
    /// # Errors
    /// The line to the board has failed.
    pub fn start(
        board: &'a mut dyn Live,
        channels: &'a Channels,
        requests: Receiver<Request>,
        stop: &'a AtomicBool,
    ) -> Result<Self, BoardError> {
        let mut session = Self {
            sampled: board.clock(),
            places: board.take_places(),
            board: Watched {
                board,
                channels,
                stop,
                pins: None,
                may_cancel: false,
            },
            hub: &channels.hub,
            requests,
            waiting: VecDeque::new(),
            channels,
            frames: VecDeque::new(),
            moved_ms: 0,
            orbit: None,
            up: Axis::Z,
            uploads: 0,
            has_prompt: false,
            meeting: None,
            kept_ms: 0,
            end: Vec::new(),
        };
        // A simulated board has just started, and its program may have no prompt, so nothing is sent to it.
        if session.board.memory().is_some() {
            session.await_prompt(String::new(), FIRST_PATIENCE_MS);
        } else {
            session.find_firmware()?;
        }
        Ok(session)
    }

    /// Starts to wait for the first prompt of a program that has just started. `started` is the text for the pages, empty for the first
    /// program.
    fn await_prompt(&mut self, started: String, wait_ms: u64) {
        self.has_prompt = false;
        let end_ms = self.board.now_ms().saturating_add(wait_ms);
        self.kept_ms = if end_ms == u64::MAX { 0 } else { end_ms };
        self.meeting = Some(Meeting { end_ms, started });
    }

    /// Starts to wait for the prompt of a board that has not answered. The prompt may have arrived meanwhile.
    fn await_prompt_again(&mut self) {
        self.await_prompt(String::new(), u64::MAX);
        self.has_prompt = self.end.ends_with(PROMPT.as_bytes());
    }

    /// Finds the prompt of the firmware of a board on a serial line, which may have run for a long time. A board without an answer may
    /// have one after its reset.
    fn find_firmware(&mut self) -> Result<(), BoardError> {
        self.send_lists(Vec::new(), Choices::default());
        let mut failure = None;
        self.has_prompt = self.ask_until_cancelled(|console, _| {
            let result = console.synchronise();
            if let Err(error @ ConsoleError::Silence { .. }) = &result {
                failure = Some(format!("{error}; {NO_ANSWER}"));
            }
            Ok(result?)
        })?;
        if self.has_prompt {
            return self.update_lists();
        }
        if let Some(failure) = failure {
            self.hub.notify(failure, true);
        }
        self.await_prompt(String::new(), u64::MAX);
        Ok(())
    }

    /// Ends the wait for the first prompt, if the prompt has arrived or the wait has timed out.
    fn end_meeting(&mut self) -> Result<(), BoardError> {
        let now = self.board.now_ms();
        let Some(meeting) =
            (self.meeting).take_if(|meeting| self.has_prompt || now >= meeting.end_ms)
        else {
            return Ok(());
        };
        let mut text = meeting.started;
        if self.has_prompt {
            self.update_lists()?;
        } else {
            text = format!("{text} {NO_PROMPT}");
        }
        if !text.is_empty() {
            self.hub.notify(text.trim_start(), false);
        }
        Ok(())
    }

    /// Replaces the running program. The pages receive the lists of the new program, which are empty for a program without a prompt.
    fn start_program(&mut self, program: Program) -> Result<(), BoardError> {
        let started = format!("{} runs, {} bytes.", program.name, program.image.len());
        if self.board.memory().is_none() {
            return self.load(program, started);
        }
        if let Err(error) = self.board.board.boot(&program.image) {
            self.hub.notify(format!("{}: {error}", program.name), true);
            return Ok(());
        }
        self.forget_program();
        self.places = program.places;
        self.await_prompt(started, FIRST_PATIENCE_MS);
        Ok(())
    }

    /// Drops everything that belongs to the running program.
    fn forget_program(&mut self) {
        self.waiting.clear();
        self.frames.clear();
        self.orbit = None;
        self.end.clear();
        self.places = Places::default();
        self.send_lists(Vec::new(), Choices::default());
    }

    /// Loads a program by the BIOS of a board on a serial line, and starts it. The pages are told if this fails; the board is then in its
    /// BIOS, or runs its earlier program. `started` is the text for the pages if it succeeds.
    fn load(&mut self, program: Program, started: String) -> Result<(), BoardError> {
        let Program {
            name,
            image,
            places,
        } = program;
        self.forget_program();
        self.await_prompt(String::new(), u64::MAX);
        let wait = format!(
            "{name}: waiting for the board's BIOS; if this takes long, press the board's reset button"
        );
        // A page may cancel the wait as soon as the notice of it arrives.
        self.board.set_may_cancel(true);
        self.hub.notify(wait, false);
        let mut report = reporter(self.hub);
        let mut is_waiting = true;
        let result = flash::flash(
            &mut self.board,
            &image,
            START_ADDRESS,
            BIOS_PATIENCE_MS,
            &mut |done, all| {
                // A reset would now end the transfer.
                if std::mem::take(&mut is_waiting) {
                    let text = format!("{name}: the board receives {all} bytes");
                    self.hub.notify(text, false);
                }
                report(done, all);
            },
        );
        self.board.set_may_cancel(false);
        let error = match result {
            Ok(mut report) => {
                self.hub.notify(started, false);
                self.places = places;
                self.kept_ms = self.board.now_ms().saturating_add(LOADED_PATIENCE_MS);
                return self.pass(&mut report.said);
            }
            Err(FlashError::Board(BoardError::Cancelled)) => STOPPED.to_owned(),
            Err(FlashError::Board(error)) => return Err(error),
            Err(error) => error.to_string(),
        };
        Console::new(&mut self.board).end_boot()?;
        self.hub.end_progress();
        self.hub.notify(format!("{name}: {error}"), true);
        Ok(())
    }

    /// Time by which the board is ahead of its clock, for a clock that cannot wait.
    pub fn early(&mut self) -> Duration {
        self.board.board.early()
    }

    /// Runs the board for a short time, and then executes one request or a measurement that is due.
    ///
    /// # Errors
    /// The line to the board has failed.
    pub fn step(&mut self) -> Result<(), BoardError> {
        let mut output = Vec::new();
        self.board.read(&mut output, POLL_MS)?;
        self.pass(&mut output)?;
        self.end_meeting()?;
        self.drop_vain_requests();
        if !self.is_idle() {
            return match self.receive()? {
                // The user's keys go to the running program, as on a terminal.
                Some(Request::Command(line)) => self.type_line(&line),
                Some(Request::Choose(list, name)) => self.choose(list, &name),
                Some(Request::Interrupt) => self.board.write(INTERRUPT),
                Some(Request::Start(program)) => self.start_program(program),
                Some(
                    request @ (Request::Help(_)
                    | Request::Picture
                    | Request::Upload(_)
                    | Request::Scene(_)),
                ) => {
                    self.keep(request);
                    Ok(())
                }
                None => Ok(()),
            };
        }
        let next = match self.waiting.pop_front() {
            None => self.receive()?,
            waiting => waiting,
        };
        match next {
            Some(Request::Command(line)) => self.type_line(&line),
            Some(Request::Choose(list, name)) => self.choose(list, &name),
            Some(Request::Help(command)) => {
                self.ask(|console, hub| send_help(console, hub, command))
            }
            Some(Request::Upload(file)) => {
                self.uploads = self.uploads.wrapping_add(1);
                let session = self.uploads;
                self.up = file.up.unwrap_or(self.up);
                self.ask_until_cancelled(|console, hub| upload(console, hub, &file, session))?;
                if self.has_prompt {
                    self.update_lists()?;
                }
                Ok(())
            }
            Some(Request::Scene(scene)) => self.show_scene(scene),
            Some(Request::Picture) => self.ask_until_cancelled(send_picture).map(drop),
            Some(Request::Interrupt) => Ok(()),
            Some(Request::Start(program)) => self.start_program(program),
            None => self.use_rest(),
        }
    }

    /// Executes one task for which no request may be waiting: moves the camera, measures, or moves
    /// a field.
    fn use_rest(&mut self) -> Result<(), BoardError> {
        if let Some(drag) = self.channels.take_drag() {
            return self.move_camera(&drag);
        }
        if self.is_sample_due() {
            self.ask(send_sample)?;
            self.sampled = self.board.board.clock();
            return Ok(());
        }
        self.move_field()
    }

    /// Takes the next request of a page. Motions of the camera from before the request are executed
    /// first. A request that may change the picture ends the motion of a field.
    fn receive(&mut self) -> Result<Option<Request>, BoardError> {
        let Ok(request) = self.requests.try_recv() else {
            return Ok(None);
        };
        if self.is_idle()
            && let Some(drag) = self.channels.take_drag()
        {
            self.move_camera(&drag)?;
        }
        if !matches!(request, Request::Help(_) | Request::Picture) {
            self.frames.clear();
            self.orbit = None;
        }
        Ok(Some(request))
    }

    /// Types the commands of a choice: the first command at once, because it may end a running
    /// program, and the others one by one.
    fn choose(&mut self, list: List, name: &str) -> Result<(), BoardError> {
        self.waiting
            .retain(|earlier| !matches!(earlier, Request::Command(_)));
        let Some(choice) = self.channels.choices().find(list, name).cloned() else {
            return Ok(());
        };
        let mut commands = choice.commands.into_iter();
        let first = commands.next().unwrap_or_default();
        self.type_line(&first)?;
        self.waiting.extend(commands.map(Request::Command));
        self.frames = choice.frames.into();
        Ok(())
    }

    /// Uploads the files of a scene, and executes its commands, up to the first one that the board refuses.
    fn show_scene(&mut self, scene: Scene) -> Result<(), BoardError> {
        let session = self.uploads.wrapping_add(1);
        self.uploads = session.wrapping_add(scene.files.len() as u8);
        let is_shown =
            self.ask_until_cancelled(|console, hub| show_scene(console, hub, &scene, session))?;
        if !is_shown {
            return Ok(());
        }
        if !scene.files.is_empty() {
            self.update_lists()?;
        }
        let title = format!("the scene {} is shown", scene.name);
        let text: Vec<_> = [title].into_iter().chain(scene.remarks).collect();
        self.hub.notify(text.join("; "), false);
        scene.control.map_or(Ok(()), |line| self.type_line(&line))
    }

    /// Moves the camera around the subject. The first motion stops the steering by sensor and hand.
    fn move_camera(&mut self, drag: &Drag) -> Result<(), BoardError> {
        let mut orbit = self.orbit;
        self.ask(|console, _| {
            if orbit.is_none() {
                for command in ["imu off", "gesture off"] {
                    optional(console.command(command))?;
                }
            }
            let lines = console.command("view")?;
            let line = lines.first().map(String::as_str).unwrap_or_default();
            let Ok(Some(Command::Set(Setting::View { view }))) = Command::parse(line) else {
                return Ok(());
            };
            let up = match orbit {
                Some((last, up)) if last == view => up,
                _ => orbit::up(&view),
            };
            if let Some(moved) = orbit::moved(&view, drag, up) {
                console.command(&format!("view {moved}"))?;
                orbit = Some((moved, up));
            }
            Ok(())
        })?;
        self.orbit = orbit;
        Ok(())
    }

    /// Shows the next picture of a moving field, if a moving field is shown and the picture is due.
    fn move_field(&mut self) -> Result<(), BoardError> {
        let now = self.board.now_ms();
        if now < self.moved_ms + FRAME_MS || !self.hub.has_viewers() {
            return Ok(());
        }
        let Some(command) = self.frames.pop_front() else {
            return Ok(());
        };
        self.moved_ms = now;
        if self.try_ask(|console, _| Ok(console.command(&command).map(drop)?))? {
            self.frames.push_back(command);
        } else {
            self.frames.clear();
        }
        Ok(())
    }

    /// Queues a request until the console waits for a command. It replaces a queued request with
    /// the same [`Request::key`]. A [`Request::Help`] above the limit is dropped: a valid
    /// page sends at most one for each command, and the firmware has fewer commands than the limit.
    fn keep(&mut self, request: Request) {
        self.waiting
            .retain(|earlier| earlier.key() != request.key());
        if self.waiting.len() < MAX_REQUESTS || !matches!(request, Request::Help(_)) {
            self.waiting.push_back(request);
        }
    }

    /// Drops the queued requests that only the firmware can execute, if no program has a prompt or has just started, and tells the pages.
    fn drop_vain_requests(&mut self) {
        if self.has_prompt || self.board.now_ms() < self.kept_ms {
            return;
        }
        let count = self.waiting.len();
        (self.waiting).retain(|request| {
            !matches!(
                request,
                Request::Picture | Request::Upload(_) | Request::Scene(_)
            )
        });
        if self.waiting.len() < count {
            self.hub.notify(NO_FIRMWARE, true);
        }
    }

    /// Whether the next measurement is due.
    fn is_sample_due(&self) -> bool {
        let live = &self.board.board;
        live.clock() >= self.sampled + live.sample_period() && self.hub.has_viewers()
    }

    /// Passes output of the console to the viewers.
    fn pass(&mut self, output: &mut Vec<u8>) -> Result<(), BoardError> {
        if output.is_empty() {
            return Ok(());
        }
        self.hub.send_console(output);
        if let Some(place) = self.places.hear(output) {
            self.hub.send_console(format!("{place}\r\n").as_bytes());
        }
        self.end.append(output);
        self.has_prompt |= self.end.ends_with(PROMPT.as_bytes());
        // The page cannot serve a transfer that a user has started on the console, so the session
        // cancels the transfer.
        let is_transfer = self.end.ends_with(b"\nready\r\n");
        let kept = self.end.len().saturating_sub(2 * PROMPT.len());
        self.end.drain(..kept);
        if is_transfer {
            Console::new(&mut self.board).reset_transfer()?;
        }
        Ok(())
    }

    /// Whether the console waits for a command.
    fn is_idle(&self) -> bool {
        self.has_prompt && (self.end.is_empty() || self.end.ends_with(PROMPT.as_bytes()))
    }

    fn type_line(&mut self, line: &str) -> Result<(), BoardError> {
        self.end = line.into();
        // The firmware's line editor drops what was typed before this byte.
        let clear = if self.has_prompt { "\0" } else { "" };
        self.board.write(format!("{clear}{line}\r").as_bytes())
    }

    /// Runs a task on the console up to the next prompt. The viewers do not receive the output. If the board does not answer, the session
    /// waits for its prompt.
    fn ask(
        &mut self,
        task: impl FnOnce(&mut Console<Watched>, &Hub) -> Result<(), TransferError>,
    ) -> Result<(), BoardError> {
        self.try_ask(task).map(drop)
    }

    /// Runs a task like [`ask`](Self::ask), and returns whether it has succeeded.
    fn try_ask(
        &mut self,
        task: impl FnOnce(&mut Console<Watched>, &Hub) -> Result<(), TransferError>,
    ) -> Result<bool, BoardError> {
        let mut console = Console::new(&mut self.board);
        let result = task(&mut console, self.hub).and_then(|()| Ok(console.greet().map(drop)?));
        // Replies to lines that were typed ahead, and a line that the firmware prints before its prompt, belong to the output for the
        // viewers.
        let earlier = console.take_earlier();
        let mut rest = std::mem::take(console.line().1);
        if !earlier.is_empty() {
            self.hub.send_console(earlier.as_bytes());
        }
        self.end.clear();
        self.pass(&mut rest)?;
        match result {
            Ok(()) => Ok(true),
            Err(TransferError::Board(error))
            | Err(TransferError::Console(ConsoleError::Board(error))) => Err(error),
            Err(error) => {
                self.hub.notify(error.to_string(), true);
                if let TransferError::Console(ConsoleError::Silence { .. } | ConsoleError::Bios) =
                    error
                {
                    self.await_prompt_again();
                }
                Ok(false)
            }
        }
    }

    /// Runs a task like [`try_ask`](Self::try_ask), until a page cancels it.
    fn ask_until_cancelled(
        &mut self,
        task: impl FnOnce(&mut Console<Watched>, &Hub) -> Result<(), TransferError>,
    ) -> Result<bool, BoardError> {
        self.board.set_may_cancel(true);
        let result = self.try_ask(task);
        self.board.set_may_cancel(false);
        let has_succeeded = match result {
            Err(BoardError::Cancelled) => {
                // The next cancellation ends the synchronisation.
                self.board.set_may_cancel(true);
                self.hub.notify(STOPPED, true);
                // The board ends the transfer, and the rest of the reply is dropped.
                if self.has_prompt {
                    self.synchronise()?;
                }
                self.board.set_may_cancel(false);
                false
            }
            result => result?,
        };
        if !has_succeeded {
            self.hub.end_progress();
        }
        Ok(has_succeeded)
    }

    /// Synchronises with the firmware, until a page cancels this. Without success, the session waits for the prompt.
    fn synchronise(&mut self) -> Result<(), BoardError> {
        match self.try_ask(|console, _| Ok(console.synchronise()?)) {
            Ok(true) => {}
            Ok(false) | Err(BoardError::Cancelled) => self.await_prompt_again(),
            Err(error) => return Err(error),
        }
        Ok(())
    }

    /// Reads the firmware's lists, and sends them to the pages.
    fn update_lists(&mut self) -> Result<(), BoardError> {
        let (mut choices, mut listed) = (Choices::default(), Vec::new());
        let up = self.up;
        self.ask(|console, _| {
            let entry = |line: &String| {
                let (name, text) = line.split_once(' ')?;
                let (name, text) = (name.to_owned(), text.trim().to_owned());
                (!name.starts_with('`')).then_some(Entry { name, text })
            };
            let commands: Vec<_> = console.command("help")?.iter().filter_map(entry).collect();
            let fits = commands.iter().any(|entry| entry.name == "fit");
            let fit = |name: &str| match name {
                MODEL => format!("fit {up}"),
                _ => "fit".to_owned(),
            };
            choices = Choices::new(
                &|name| fits.then(|| fit(name)),
                &optional(console.command("scene"))?,
                &optional(console.command("models"))?,
                &optional(console.command("help field"))?,
            );
            listed = commands;
            Ok(())
        })?;
        self.send_lists(listed, choices);
        Ok(())
    }

    /// Sends the lists of commands and choices to the pages.
    fn send_lists(&self, commands: Vec<Entry>, choices: Choices) {
        let names = |list| {
            let names = choices.of(list).iter().map(|choice| choice.name.clone());
            names.collect()
        };
        self.hub.send(&ToPage::Lists {
            commands,
            scenes: names(List::Scenes),
            meshes: names(List::Meshes),
            fields: names(List::Fields),
        });
        self.channels.set_choices(choices);
    }
}

/// The lines of a reply; empty if the firmware refuses the command.
fn optional(reply: Result<Vec<String>, ConsoleError>) -> Result<Vec<String>, ConsoleError> {
    match reply {
        Err(ConsoleError::Refused { .. }) => Ok(Vec::new()),
        reply => reply,
    }
}

fn send_help(
    console: &mut Console<Watched>,
    hub: &Hub,
    command: String,
) -> Result<(), TransferError> {
    let lines = optional(console.command(&format!("help {command}")))?;
    hub.send(&ToPage::Help { command, lines });
    Ok(())
}

fn send_sample(console: &mut Console<Watched>, hub: &Hub) -> Result<(), TransferError> {
    let stats = optional(console.command("stats json"))?;
    let stats = stats
        .first()
        .and_then(|line| serde_json::from_str(line).ok());
    let lines = optional(console.command("imu"))?;
    let attitude: Option<String> = console::value("imu", &lines, "attitude").ok();
    let attitude = attitude.and_then(|text| {
        let numbers: Result<Vec<f64>, _> = text.split(' ').map(str::parse).collect();
        <[f64; 4]>::try_from(numbers.ok()?).ok()
    });
    hub.send(&ToPage::Sample {
        ms: console.board().now_ms(),
        stats: stats.unwrap_or(Value::Null),
        attitude,
    });
    Ok(())
}

/// Downloads the last frame, and sends its colours as a picture to the viewers.
fn send_picture(console: &mut Console<Watched>, hub: &Hub) -> Result<(), TransferError> {
    let command = "info size";
    let lines = console.command(command)?;
    let size: String = console::value(command, &lines, "size")?;
    let size = size
        .split_once(' ')
        .and_then(|(width, height)| Size::of(width.parse().ok()?, height.parse().ok()?));
    let Some(size) = size else {
        hub.notify(
            format!("{command}: expected a width and a height, found {lines:?}"),
            true,
        );
        return Ok(());
    };
    let length = 2 * size.pixel_count();
    let data = transfer::download(console, "frame", length, &mut reporter(hub))?;
    let (pixels, _) = data.as_chunks();
    hub.show(&Frame {
        width: size.width() as usize,
        height: size.height() as usize,
        pixels: pixels
            .iter()
            .map(|&pixel| u16::from_le_bytes(pixel))
            .collect(),
    });
    Ok(())
}

/// Sends the progress of a transfer to the pages.
fn reporter(hub: &Hub) -> impl FnMut(u64, u64) {
    let mut reported = 0;
    move |done, all| {
        let part = done * REPORTS / all.max(1);
        if part != reported {
            reported = part;
            hub.send(&ToPage::Progress { done, all });
        }
    }
}

fn upload(
    console: &mut Console<Watched>,
    hub: &Hub,
    file: &Upload,
    session: u8,
) -> Result<(), TransferError> {
    let Upload {
        name,
        bytes,
        up,
        remarks,
    } = file;
    if console.board().memory().is_some() {
        transfer::stage(console, bytes)?;
    }
    let notes = transfer::upload(console, bytes, Some(name), session, &mut reporter(hub))?;
    let size = bytes.len() as u64;
    let mut text = match up {
        Some(up) => {
            transfer::show(console, name, *up)?;
            format!("the model is shown: {size} bytes")
        }
        None => format!("the texture {name} is uploaded: {size} bytes"),
    };
    hub.send(&ToPage::Progress {
        done: size,
        all: size,
    });
    for remark in remarks.iter().chain(&notes) {
        text = format!("{text}; {remark}");
    }
    hub.notify(text, false);
    Ok(())
}

/// Uploads the files of a scene, and executes its commands. The first transfer has the number `session`. The notes of the board on a file
/// are dropped, because they are about the scene that is shown during the upload.
fn show_scene(
    console: &mut Console<Watched>,
    hub: &Hub,
    scene: &Scene,
    mut session: u8,
) -> Result<(), TransferError> {
    for File {
        name,
        bytes,
        is_program,
    } in &scene.files
    {
        if console.board().memory().is_some() {
            transfer::stage(console, bytes)?;
        }
        let name = Some(name.as_str());
        let progress = &mut reporter(hub);
        if *is_program {
            transfer::upload_program(console, bytes, name, session, progress)?;
        } else {
            transfer::upload(console, bytes, name, session, progress)?;
        }
        session = session.wrapping_add(1);
    }
    hub.end_progress();
    for command in &scene.commands {
        console.command(command)?;
    }
    Ok(())
}
