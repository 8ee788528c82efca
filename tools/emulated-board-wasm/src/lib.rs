//! The emulated board and the session of the live page, as WebAssembly for a web worker of the page.
//!
//! The worker (`web/worker.js`) writes bytes to the [`inbox`] and passes them on by [`start`], [`receive_text`] or
//! [`receive_bytes`]; [`run`] runs the board until it is ahead of the page's clock, and [`take`] passes the messages for the page
//! to `deliver`. docs/live-page.md defines all numbers and bytes.

use std::cell::RefCell;
use std::panic;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use emulated_board::EmulatedBoard;
use glint_board_api::pace::Clock;
use glint_board_api::{BoardError, SimulatedBoard};
use glint_live_page::{Channels, Live, LiveSimulation, Message, Places, Session, Viewer};

/// Longest time that the board runs before the worker checks for messages from the page; a pass of an engine may take longer.
const TURN: Duration = Duration::from_millis(8);

/// Interval of the measurements on the console.
const SAMPLE_PERIOD: Duration = Duration::from_millis(250);

// SAFETY: `web/worker.js` implements these functions. `deliver` reads the bytes of the module's memory during the call only.
unsafe extern "C" {
    /// Time in ms since the start of the worker.
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

/// The board, and its connection to the page.
struct Page {
    session: Session<'static>,
    channels: &'static Channels,
    viewer: Viewer,
}

thread_local! {
    static INBOX: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static PAGE: RefCell<Option<Page>> = const { RefCell::new(None) };
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

/// Starts the board with the firmware in the inbox.
#[unsafe(no_mangle)]
pub extern "C" fn start() {
    panic::set_hook(Box::new(|info| {
        send(Kind::End, info.to_string().as_bytes())
    }));
    match INBOX.with_borrow(|firmware| opened(firmware)) {
        Ok(page) => PAGE.set(Some(page)),
        Err(error) => end(&error),
    }
}

fn opened(firmware: &[u8]) -> Result<Page, BoardError> {
    let board = EmulatedBoard::fast(firmware).map_err(BoardError::simulation)?;
    let board = SimulatedBoard::new(board);
    let live: &mut dyn Live = Box::leak(Box::new(LiveSimulation::new(
        board,
        Places::default(),
        SAMPLE_PERIOD,
        PageClock,
    )));
    let (channels, requests) = Channels::new(live, "emulated", false);
    let channels = Box::leak(Box::new(channels));
    let viewer = Viewer::join(channels).expect("this is the only page");
    static STOP: AtomicBool = AtomicBool::new(false);
    let session = Session::start(live, channels, requests, &STOP)?;
    Ok(Page {
        session,
        channels,
        viewer,
    })
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

/// Runs the board until it is ahead of the page's clock, but at most a few milliseconds. Returns the milliseconds by which it is
/// ahead.
#[unsafe(no_mangle)]
pub extern "C" fn run() -> f64 {
    let early = with_page(|page| {
        let stop = PageClock.now() + TURN;
        loop {
            let early = page.session.early();
            if !early.is_zero() || PageClock.now() >= stop {
                return Ok(early);
            }
            page.session.step()?;
        }
    });
    let early = early.unwrap_or(Ok(Duration::ZERO));
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

/// Stops the board.
fn end(reason: &dyn ToString) {
    PAGE.set(None);
    send(Kind::End, reason.to_string().as_bytes());
}
