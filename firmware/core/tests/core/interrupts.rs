//! Tests of transfers that a new session or Ctrl-C cancels.

use glint_core::wire::{self, Failure, MAX_FRAME, Reason, Receiver, Sender, State, Timing};

/// A receiver of 300 bytes in the middle of a transfer: the sender has stopped in the second frame.
fn left_alone(buffer: &mut [u8]) -> Receiver<'_> {
    let data = [0x5A; 300];
    let mut sender = Sender::new(&data, 0, Timing::HOST, 0);
    let mut receiver = Receiver::new(buffer, None, Timing::CONSOLE, 0);
    let (mut frame, mut answer) = ([0; MAX_FRAME], [0; MAX_FRAME]);
    let length = sender.poll(0, &mut frame);
    receiver.on_bytes(0, &frame[..length]);
    let length = receiver.poll(0, &mut answer);
    sender.on_bytes(0, &answer[..length]);
    let length = sender.poll(0, &mut frame);
    receiver.on_bytes(0, &frame[..length / 2]);
    assert_eq!(receiver.state(), State::Running);
    receiver
}

const INTERRUPTED: State = State::Failed(Failure::AbortedByPeer(Reason::Cancelled));

#[test]
fn a_new_conversation_ends_a_transfer_that_was_left() {
    let mut frame = [0; MAX_FRAME];
    let mut reset = [0; MAX_FRAME];
    let length = wire::reset(&mut reset);
    let reset = &reset[..length];
    let (mut small, mut large) = ([0; 10], [0; 300]);
    // The frame that cancels the transfer arrives before the first frame, and within a frame.
    for mut receiver in [
        Receiver::new(&mut small, None, Timing::CONSOLE, 0),
        left_alone(&mut large),
    ] {
        let text = [reset, b"info\r"].concat();
        assert_eq!(receiver.on_bytes(5, &text), length);
        assert_eq!(receiver.poll(5, &mut frame), 0);
        assert_eq!(receiver.state(), INTERRUPTED);
    }
    let data = [0x5A; 300];
    let mut sender = Sender::new(&data, 7, Timing::CONSOLE, 0);
    assert!(sender.poll(0, &mut frame) > 0);
    sender.on_bytes(1, reset);
    assert_eq!(sender.poll(1, &mut frame), 0);
    assert_eq!(sender.state(), INTERRUPTED);
}

#[test]
fn ctrl_c_alone_ends_a_transfer_and_in_a_frame_does_not() {
    let mut frame = [0; MAX_FRAME];
    let (mut small, mut large) = ([0; 10], [0; 300]);
    for mut receiver in [
        Receiver::new(&mut small, None, Timing::CONSOLE, 0),
        left_alone(&mut large),
    ] {
        receiver.on_bytes(100, b"\x03");
        receiver.poll(149, &mut frame);
        assert_eq!(receiver.state(), State::Running);
        receiver.poll(150, &mut frame);
        assert_eq!(receiver.state(), INTERRUPTED);
    }
    // A frame may contain the byte of Ctrl-C, but then its next bytes follow at once.
    let mut receiver = left_alone(&mut large);
    receiver.on_bytes(100, b"\0\x03");
    receiver.on_bytes(101, b"x");
    receiver.poll(500, &mut frame);
    assert_eq!(receiver.state(), State::Running);
}
