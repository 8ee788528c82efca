//! The sensor's stream: a future that is polled in interrupts, and the queue of its events for the main loop.
//!
//! The end of a transfer, of a batch of samples or of a pause raises an interrupt, whose handler polls the stream. Samples are therefore
//! read on time even while the main program is busy, and wait in the queue.

use core::cell::{Cell, RefCell};
use core::mem;
use core::pin::Pin;
use core::task::{Context, Waker};

use critical_section::Mutex;
use glint_core::feature::IMU;
use glint_core::mpu6050::{Error, Identity, Measurement, Sink};
use glint_core::tasks::Turn;
use glint_hal::i2c;
use heapless::Deque;
use litex_pac::cpu;

/// Samples, attitude and calibration of the sensor.
pub type Imu = glint_core::imu::Imu<i2c::BusError>;

/// Reason why the sensor sends no samples.
pub type SensorError = Error<i2c::BusError>;

/// Reason why a calibration failed.
pub type CalibrationError = glint_core::imu::CalibrationError<i2c::BusError>;

/// An event of the stream: a start of the sensor, a sample with its time, or an error.
enum Event {
    Start(Identity),
    Sample(u64, Measurement),
    Error(SensorError),
}

/// Capacity of the queue of events: the samples of one second, because a single turn of a task, such as the check of an uploaded mesh, can
/// take that long.
const QUEUE: usize = 1024;

/// The future that reads the sensor and never ends.
struct Stream(Pin<&'static mut dyn Future<Output = ()>>);

// SAFETY: there is one core, and the stream is accessed only in critical sections, which exclude interrupts.
unsafe impl Send for Stream {}

static STREAM: Mutex<RefCell<Option<Stream>>> = Mutex::new(RefCell::new(None));
static EVENTS: Mutex<RefCell<Deque<Event, QUEUE>>> = Mutex::new(RefCell::new(Deque::new()));
/// Clock cycles spent by the stream, and clock cycles spent by the processing of its samples.
static CYCLES: Mutex<Cell<[u64; 2]>> = Mutex::new(Cell::new([0; 2]));

/// The receiver of the stream's events, which puts them into the queue.
pub struct Inbox;

impl Inbox {
    fn push(event: Event) {
        critical_section::with(|token| {
            // If the queue is full, the event is dropped. The receiver detects the loss by the gap between the time stamps of the samples.
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

/// Starts the stream: from now on, interrupts poll the future `stream`, which passes its events to the [`Inbox`].
///
/// # Safety
/// The caller must never return.
pub unsafe fn start(stream: Pin<&mut dyn Future<Output = ()>>) {
    if !IMU.is_built {
        return;
    }
    // SAFETY: the future is a local variable of a function that does not return, so the future is never dropped.
    let stream = unsafe {
        mem::transmute::<Pin<&mut dyn Future<Output = ()>>, Pin<&'static mut dyn Future<Output = ()>>>(
            stream,
        )
    };
    let stream = Stream(stream);
    critical_section::with(|token| STREAM.replace(token, Some(stream)));
    advance(cpu::cycles_low());
}

/// Polls the stream. Call this after an interrupt at the end of a transfer or pause. Adds the cycles since `start` to the cycles of the
/// stream.
pub fn advance(start: u32) {
    if !IMU.is_built {
        return;
    }
    critical_section::with(|token| {
        if let Some(stream) = &mut *STREAM.borrow_ref_mut(token) {
            let mut context = Context::from_waker(Waker::noop());
            // The stream never ends, so the result is always `Pending`.
            let _ = stream.0.as_mut().poll(&mut context);
        }
    });
    count(0, start);
}

/// Adds the clock cycles since `start` to one of the two counters of `CYCLES`, selected by `which`.
fn count(which: usize, start: u32) {
    let cycles = cpu::cycles_low().wrapping_sub(start);
    critical_section::with(|token| {
        let mut all = CYCLES.borrow(token).get();
        all[which] += u64::from(cycles);
        CYCLES.borrow(token).set(all);
    });
}

/// Clock cycles since reset spent by the stream, and those spent by the processing of its samples, both including interrupts.
pub fn cycles() -> [u64; 2] {
    critical_section::with(|token| CYCLES.borrow(token).get())
}

/// Passes all queued events to `imu`.
pub fn deliver(imu: &mut Imu) -> Turn {
    deliver_each(imu, &mut |_| {})
}

/// Passes all queued events to `imu`, and calls `on_sample` after each sample.
pub fn deliver_each(imu: &mut Imu, on_sample: &mut dyn FnMut(&Imu)) -> Turn {
    let mut turn = Turn::Wait;
    if !IMU.is_built {
        return turn;
    }
    while let Some(event) = critical_section::with(|token| EVENTS.borrow_ref_mut(token).pop_front())
    {
        turn = Turn::Again;
        match event {
            Event::Start(identity) => imu.on_start(identity),
            Event::Sample(time, measurement) => {
                let start = cpu::cycles_low();
                imu.on_sample(time, &measurement);
                count(1, start);
                on_sample(imu);
            }
            Event::Error(error) => imu.on_error(error),
        }
    }
    turn
}
