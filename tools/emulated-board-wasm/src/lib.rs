//! The board and the session of the live page, as WebAssembly for a web worker of the page: an emulated board, or a board on a serial
//! port of the browser.
//!
//! The worker (`web/worker.js`) writes bytes to the [`inbox`] and passes them on by [`start`], [`connect`], [`receive_text`] or
//! [`receive_bytes`]; [`run`] runs the session until the board is ahead of the page's clock, and [`take`] passes the messages for the page
//! to `deliver`. docs/live-page.md defines all numbers and bytes.
//!
//! A session with a serial port waits for bytes within [`connect`] and [`run`]: the worker suspends these two calls, and meanwhile calls the
//! other functions. They use no state that a suspended call has borrowed.

mod port;

use std::cell::RefCell;
use std::panic;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use emulated_board::EmulatedBoard;
use glint_board_api::pace::Clock;
use glint_board_api::{BoardError, SimulatedBoard};
use glint_live_page::{Channels, Live, LiveSimulation, Message, Places, Session, Viewer};
use port::SerialPort;

/// Longest time that the board runs before the worker checks for messages from the page; a pass of an engine may take longer.
const TURN: Duration = Duration::from_millis(8);

/// Interval of the measurements on the console.
const SAMPLE_PERIOD: Duration = Duration::from_millis(250);

// SAFETY: `web/worker.js` implements these functions. `deliver` reads the bytes of the module's memory during the call only.
unsafe extern "C" {
    /// Time in ms since 1970.
    safe fn now() -> f64;

    /// Delivers the `length` bytes from address `start` on, a message of the kind `kind`.
    safe fn deliver(kind: Kind, start: *const u8, length: usize);
}

/// Kinds of messages to the worker.
#[repr(u32)]
#[derive(Clone, Copy)]
enum Kind {
    /// A text message to the page.
    Text = 0,
    /// A picture for the page.
    Picture = 1,
    /// The reason why the board has stopped.
    End = 2,
}

fn send(kind: Kind, bytes: &[u8]) {
    deliver(kind, bytes.as_ptr(), bytes.len());
}

/// The page's clock. `wait` returns at once, because this module must not block; the worker delays
/// the next turn instead.
struct PageClock;

impl Clock for PageClock {
    fn now(&self) -> Duration {
        Duration::from_secs_f64(now() / 1000.0)
    }

    fn wait(&self, _time: Duration) {}
}

/// The connection to the page.
struct Page {
    channels: &'static Channels,
    viewer: Viewer,
}

thread_local! {
    static INBOX: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static PAGE: RefCell<Option<Page>> = const { RefCell::new(None) };
    /// The session with the board, borrowed while [`run`] waits for a serial port.
    static SESSION: RefCell<Option<Session<'static>>> = const { RefCell::new(None) };
}

/// Resizes the inbox to `length` bytes, and returns its address, where the worker writes the bytes before the next call.
#[unsafe(no_mangle)]
pub extern "C" fn inbox(length: usize) -> *mut u8 {
    INBOX.with_borrow_mut(|inbox| {
        inbox.clear();
        inbox.resize(length, 0);
        inbox.as_mut_ptr()
    })
}

/// Starts the emulated board with the firmware in the inbox.
#[unsafe(no_mangle)]
pub extern "C" fn start() {
    report_panics();
    match INBOX.with_borrow(|firmware| EmulatedBoard::fast(firmware)) {
        Ok(board) => {
            let board = SimulatedBoard::new(board);
            let places = Places::default();
            let live = LiveSimulation::new(board, places, SAMPLE_PERIOD, PageClock);
            open(Box::new(live), "emulated");
        }
        Err(error) => end(&error),
    }
}

/// Starts the session with the board on the serial port that the worker has opened. The name of the port is in the inbox.
#[unsafe(no_mangle)]
pub extern "C" fn connect() {
    report_panics();
    let name = INBOX.with_borrow(|name| String::from_utf8_lossy(name).into_owned());
    open(Box::new(SerialPort), &name);
}

/// Makes a panic the reason why the board has stopped.
fn report_panics() {
    panic::set_hook(Box::new(|info| {
        send(Kind::End, info.to_string().as_bytes())
    }));
}

fn open(board: Box<dyn Live>, name: &str) {
    static STOP: AtomicBool = AtomicBool::new(false);
    let board = Box::leak(board);
    let (channels, requests) = Channels::new(board, name, false);
    let channels = Box::leak(Box::new(channels));
    let viewer = Viewer::join(channels).expect("this is the only page");
    PAGE.set(Some(Page { channels, viewer }));
    match Session::start(board, channels, requests, &STOP) {
        Ok(session) => SESSION.set(Some(session)),
        Err(error) => end(&error),
    }
}

/// Receives the text in the inbox, a message from the page.
#[unsafe(no_mangle)]
pub extern "C" fn receive_text() {
    receive(|page, bytes| {
        let text = String::from_utf8_lossy(bytes);
        page.viewer.receive_text(&text, page.channels)
    });
}

/// Receives the bytes in the inbox, a part of a file from the page.
#[unsafe(no_mangle)]
pub extern "C" fn receive_bytes() {
    receive(|page, bytes| page.viewer.receive_bytes(bytes, page.channels));
}

fn receive<E: ToString>(act: impl FnOnce(&mut Page, &[u8]) -> Result<(), E>) {
    let result = with_page(|page| INBOX.with_borrow(|bytes| act(page, bytes)));
    if let Some(Err(reason)) = result {
        end(&reason);
    }
}

/// Runs the session until the board is ahead of the page's clock, but at most a few milliseconds of work. Returns the milliseconds by which
/// it is ahead.
#[unsafe(no_mangle)]
pub extern "C" fn run() -> f64 {
    let early = SESSION.with_borrow_mut(|session| {
        let Some(session) = session else {
            return Ok(Duration::ZERO);
        };
        let stop = PageClock.now() + TURN;
        loop {
            let early = session.early();
            if !early.is_zero() || PageClock.now() >= stop {
                return Ok(early);
            }
            session.step()?;
        }
    });
    let early = early.inspect_err(|error: &BoardError| end(error));
    early.unwrap_or_default().as_secs_f64() * 1000.0
}

/// Delivers the queued messages to the page.
#[unsafe(no_mangle)]
pub extern "C" fn take() {
    let messages = with_page(|page| page.channels.hub.take(page.viewer.id()));
    match messages {
        Some(Some(messages)) => messages.iter().for_each(|message| match message {
            Message::Text(text) => send(Kind::Text, text.as_bytes()),
            Message::Binary(picture) => send(Kind::Picture, picture),
        }),
        Some(None) => end(&"the page has fallen behind"),
        None => {}
    }
}

/// Calls `act` with the page, if the board has started and has not stopped.
fn with_page<T>(act: impl FnOnce(&mut Page) -> T) -> Option<T> {
    PAGE.with_borrow_mut(|page| page.as_mut().map(act))
}

/// Stops the board; the worker ends.
fn end(reason: &dyn ToString) {
    PAGE.set(None);
    send(Kind::End, reason.to_string().as_bytes());
}
