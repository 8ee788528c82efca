//! The sensor's stream: a future that interrupts drive, and what came of it for the main loop.
//!
//! The end of a transfer, of some rounds, and of a pause are interrupts, and each lets the stream go on. So samples are read when they are due,
//! whatever the program does meanwhile; what comes of them waits in a queue until the program has time.

use core::cell::{Cell, RefCell};
use core::mem;
use core::pin::Pin;
use core::task::{Context, Waker};

use critical_section::Mutex;
use glint_core::mpu6050::{Error, Identity, Measurement, Sink};
use glint_hal::i2c;
use heapless::Deque;
use litex_pac::cpu;

/// The sensor, and what follows it.
pub type Imu = glint_core::imu::Imu<i2c::BusError>;

/// What has happened.
enum Event {
    Start(Identity),
    Sample(u64, Measurement),
    Error(Error<i2c::BusError>),
}

/// As many samples as come while a long frame is drawn.
const WAITING: usize = 256;

/// A stream that never ends.
struct Stream(Pin<&'static mut dyn Future<Output = ()>>);

// SAFETY: there is one core, and so nobody else to send it to but interrupts, which a critical section keeps away.
unsafe impl Send for Stream {}

static STREAM: Mutex<RefCell<Option<Stream>>> = Mutex::new(RefCell::new(None));
static EVENTS: Mutex<RefCell<Deque<Event, WAITING>>> = Mutex::new(RefCell::new(Deque::new()));
/// Cycles that the stream has taken, and what was made of its samples.
static CYCLES: Mutex<Cell<[u64; 2]>> = Mutex::new(Cell::new([0; 2]));

/// Where the stream puts what happens.
pub struct Inbox;

impl Inbox {
    fn push(event: Event) {
        critical_section::with(|token| {
            // Nobody has asked for so long that the attitude is lost anyway: what is new is dropped, and its time tells.
            let _ = EVENTS.borrow_ref_mut(token).push_back(event);
        });
    }
}

impl Sink<i2c::BusError> for Inbox {
    fn on_start(&mut self, identity: Identity) {
        Self::push(Event::Start(identity));
    }

    fn on_sample(&mut self, time: u64, measurement: &Measurement) {
        Self::push(Event::Sample(time, *measurement));
    }

    fn on_error(&mut self, error: Error<i2c::BusError>) {
        Self::push(Event::Error(error));
    }
}

/// Starts a stream into the [`Inbox`].
///
/// # Safety
/// The caller must never return.
pub unsafe fn start(stream: Pin<&mut dyn Future<Output = ()>>) {
    // SAFETY: what is borrowed lives in a function that does not return, so it lives for ever.
    let stream = unsafe {
        mem::transmute::<Pin<&mut dyn Future<Output = ()>>, Pin<&'static mut dyn Future<Output = ()>>>(
            stream,
        )
    };
    let stream = Stream(stream);
    critical_section::with(|token| STREAM.replace(token, Some(stream)));
    advance(cpu::cycles_low());
}

/// Lets the stream go on. Interrupts call this when a transfer or a pause has ended; the cycles since `start` count as the stream's.
pub fn advance(start: u32) {
    critical_section::with(|token| {
        if let Some(stream) = &mut *STREAM.borrow_ref_mut(token) {
            let mut context = Context::from_waker(Waker::noop());
            // It never ends.
            let _ = stream.0.as_mut().poll(&mut context);
        }
    });
    count(0, start);
}

/// Counts the cycles since `start` for one of the two.
fn count(which: usize, start: u32) {
    let cycles = cpu::cycles_low().wrapping_sub(start);
    critical_section::with(|token| {
        let mut all = CYCLES.borrow(token).get();
        all[which] += u64::from(cycles);
        CYCLES.borrow(token).set(all);
    });
}

/// Cycles that the stream has taken since its start, and what was made of its samples, with the interrupts that came meanwhile.
pub fn cycles() -> [u64; 2] {
    critical_section::with(|token| CYCLES.borrow(token).get())
}

/// Whether [`deliver`] has something.
pub fn has_news() -> bool {
    critical_section::with(|token| !EVENTS.borrow_ref(token).is_empty())
}

/// Tells `imu` what has happened.
pub fn deliver(imu: &mut Imu) {
    while let Some(event) = critical_section::with(|token| EVENTS.borrow_ref_mut(token).pop_front())
    {
        match event {
            Event::Start(identity) => imu.on_start(identity),
            Event::Sample(time, measurement) => {
                let start = cpu::cycles_low();
                imu.on_sample(time, &measurement);
                count(1, start);
            }
            Event::Error(error) => imu.on_error(error),
        }
    }
}
