//! The command `gesture`: state of the hand, camera control, calibration, and download of the mask.

use core::task::Poll;
use core::time::Duration;

use glint_core::console::{GestureAction, GestureCommands};
use glint_core::feature::GESTURE;
use glint_core::gesture::Window;
use glint_core::image_sensor::FrameSize;
use glint_program::gesture::Gesture;

use crate::error::CommandError;
use crate::job::{CommandResult, GestureJob, Job, JobResult, Reply};
use crate::machine::Machine;

/// Timeout for a small picture.
const WAIT: Duration = Duration::from_millis(500);

/// Capacity for a mask in bytes: 160×120 marks.
const MASK: usize = 160 * 120 / 8;

impl<'l> GestureCommands<'l> for Machine {
    fn gesture(&mut self, action: Option<GestureAction>) -> CommandResult<'l> {
        let clock = self.clock;
        let gesture = self.gesture.as_mut().ok_or(CommandError::NoGesture)?;
        match action {
            None => print_status(self)?,
            Some(GestureAction::On) => start(gesture, FrameSize::Qvga)?,
            Some(GestureAction::Vga) => start(gesture, FrameSize::Vga)?,
            Some(GestureAction::Off) => gesture.stop(),
            Some(action @ (GestureAction::Calibrate | GestureAction::Mask)) => {
                if !matches!(gesture.sensor(), Some(Ok(_))) {
                    return Err(CommandError::GestureOff);
                }
                let is_colour = action == GestureAction::Calibrate;
                gesture.request_picture(is_colour);
                return Ok(Reply::After(Job::Gesture(GestureJob {
                    is_colour,
                    end: clock.after(WAIT),
                })));
            }
            Some(GestureAction::Mark) => gesture.set_marked(true),
            Some(GestureAction::Unmark) => gesture.set_marked(false),
        }
        Ok(Reply::Done)
    }
}

/// Sets up the image sensor, and lets the hand steer the camera.
///
/// # Errors
/// There is no image sensor, or it does not accept its set-up.
fn start<'l>(gesture: &mut Gesture, size: FrameSize) -> Result<(), CommandError<'l>> {
    let started = gesture.start(size);
    started.map_err(CommandError::ImageSensor).map(|_| ())
}

/// Continues a job that waits for a small picture: calibrates with the picture, or sends the picture.
pub fn poll(machine: &mut Machine, job: &GestureJob) -> JobResult {
    let Machine {
        terminal,
        gesture,
        downloads,
        ..
    } = machine;
    let Some(gesture) = gesture.as_mut().filter(|_| GESTURE.is_built) else {
        return Poll::Ready(Err(CommandError::NoGesture));
    };
    let late = || match job.end.passed() {
        true => Poll::Ready(Err(CommandError::NoSensorFrame)),
        false => Poll::Pending,
    };
    if job.is_colour {
        let Some(found) = gesture.calibrate() else {
            return late();
        };
        let found = match found {
            Ok(found) => found,
            Err(error) => return Poll::Ready(Err(CommandError::HandColour(error))),
        };
        print_windows(terminal, found.windows);
        terminal.print_entry("inside", &found.inside);
        terminal.print_entry("outside", &found.outside);
        return Poll::Ready(Ok(Reply::Done));
    }
    let mut bytes = [0; MASK];
    let Some(words) = gesture.picture() else {
        return late();
    };
    for (pair, word) in bytes.chunks_exact_mut(2).zip(words) {
        pair.copy_from_slice(&word.to_be_bytes());
    }
    let [columns, rows] = gesture.picture_size(false);
    terminal.print(format_args!("mask {columns} {rows}\n"));
    let transfer = downloads.send_copy(&bytes, terminal);
    Poll::Ready(Ok(Reply::After(Job::Transfer(transfer))))
}

fn print_windows(terminal: &mut crate::terminal::Terminal, windows: [Window; 2]) {
    for (name, Window { lower, upper }) in ["window_cr", "window_cb"].into_iter().zip(windows) {
        terminal.print(format_args!("{name} {lower} {upper}\n"));
    }
}

fn print_status<'l>(machine: &mut Machine) -> Result<(), CommandError<'l>> {
    let Machine {
        terminal, gesture, ..
    } = machine;
    let gesture = gesture.as_ref().ok_or(CommandError::NoGesture)?;
    match gesture.sensor() {
        None => terminal.print_entry("sensor", &"off"),
        Some(Ok(model)) => terminal.print_entry("sensor", &model),
        Some(Err(error)) => terminal.print_entry("sensor", &error),
    }
    let signal = gesture.engine().signal();
    let running = if signal.is_running { "runs" } else { "stopped" };
    terminal.print_entry("pclk", &running);
    let [pixels, lines] = signal.seen;
    terminal.print(format_args!("received {pixels} {lines}\n"));
    match signal.fault {
        Some(fault) => terminal.print_entry("fault", &fault.text()),
        None => terminal.print_entry("fault", &"none"),
    }
    for (name, count) in gesture.engine().counters().iter() {
        terminal.print_entry(name, &count);
    }
    terminal.print_entry("hand", &gesture.presence());
    match gesture.seen() {
        None => {}
        Some(Err(doubt)) => terminal.print_entry("doubt", &doubt),
        Some(Ok(blob)) => {
            let [x, y] = blob.centre;
            let (count, confidence) = (blob.count, blob.confidence(gesture.size()));
            terminal.print(format_args!(
                "centre {x:.3} {y:.3}\narea {count}\nconfidence {confidence}\n"
            ));
        }
    }
    let pose = gesture.pose();
    let [theta, phi] = [pose.theta, pose.phi].map(|angle| angle.to_signed_degrees());
    terminal.print(format_args!("camera {:.4} {theta:.4} {phi:.4}\n", pose.r));
    print_windows(terminal, gesture.windows());
    let cycles = gesture.cycles();
    let each = cycles.total / u64::from(cycles.frames.max(1));
    terminal.print_entry("cycles_frame", &each);
    terminal.print_entry("cycles_latency", &cycles.latency);
    terminal.print_entry("cycles_latency_worst", &cycles.worst);
    Ok(())
}
