//! Passes pictures, texts and pin levels of the board to all viewers. One viewer has control.

use crate::message::{Holder, Message, Pins, ToPage, picture};
use glint_board_api::Frame;
use std::collections::{BTreeMap, VecDeque};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Maximum number of viewers.
pub const MAX_VIEWERS: usize = 16;

/// Maximum number of queued bytes for a viewer, in addition to one picture. A viewer with a longer queue is disconnected.
const MAX_WAITING: usize = 4 << 20;

/// Minimum number of bytes of earlier console output that a new viewer receives, if there is as
/// much.
const TRANSCRIPT: usize = 32 << 10;

/// Identifier of a viewer.
pub type Id = u64;

/// The queued messages for a viewer.
#[derive(Default)]
struct Queue {
    messages: VecDeque<Message>,
    bytes: usize,
    /// The newest picture; it replaces an older picture that has not been sent.
    picture: Option<Message>,
}

#[derive(Default)]
struct State {
    viewers: BTreeMap<Id, Queue>,
    last: Id,
    holder: Option<Id>,
    /// The newest messages that describe the board's state; a new viewer receives all of them.
    board: Option<Message>,
    lists: Option<Message>,
    pins: Option<Message>,
    picture: Option<Message>,
    pictures: u32,
    transcript: String,
}

impl State {
    fn send(&mut self, message: &Message) {
        for queue in self.viewers.values_mut() {
            queue.push(message.clone());
        }
    }

    /// Tells all viewers who has control.
    fn send_holder(&mut self) {
        for (id, queue) in &mut self.viewers {
            let holder = match self.holder {
                None => Holder::Nobody,
                Some(holder) if holder == *id => Holder::You,
                Some(_) => Holder::Other,
            };
            queue.push(ToPage::Control { holder }.encoded());
        }
    }
}

impl Queue {
    /// Adds a message. A queue above the limit is emptied, and the next [`Hub::take`] disconnects its viewer.
    fn push(&mut self, message: Message) {
        self.bytes += message.length();
        if self.is_behind() {
            self.messages = VecDeque::new();
        } else {
            self.messages.push_back(message);
        }
    }

    fn is_behind(&self) -> bool {
        self.bytes > MAX_WAITING
    }
}

/// The connection between the board and its viewers.
#[derive(Default)]
pub struct Hub(Mutex<State>);

impl Hub {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a viewer, and queues the board's state for it. The first viewer receives control. Returns `None` if there are too
    /// many viewers.
    pub fn join(&self) -> Option<Id> {
        let mut state = self.lock();
        if state.viewers.len() >= MAX_VIEWERS {
            return None;
        }
        state.last += 1;
        let id = state.last;
        let mut queue = Queue::default();
        let transcript = ToPage::Console {
            text: state.transcript.clone(),
        };
        let known = [&state.board, &state.lists, &state.pins];
        for message in known.into_iter().flatten() {
            queue.push(message.clone());
        }
        queue.push(transcript.encoded());
        queue.picture = state.picture.clone();
        state.viewers.insert(id, queue);
        state.holder.get_or_insert(id);
        state.send_holder();
        Some(id)
    }

    /// Removes a viewer, and releases its control.
    pub fn leave(&self, id: Id) {
        let mut state = self.lock();
        state.viewers.remove(&id);
        if state.holder == Some(id) {
            state.holder = None;
            state.send_holder();
        }
    }

    /// Gives control to a viewer, if no other viewer has it.
    pub fn take_control(&self, id: Id) {
        let mut state = self.lock();
        state.holder.get_or_insert(id);
        state.send_holder();
    }

    /// Releases the control of a viewer, if it has control.
    pub fn release_control(&self, id: Id) {
        let mut state = self.lock();
        if state.holder == Some(id) {
            state.holder = None;
            state.send_holder();
        }
    }

    /// Whether the viewer has control.
    pub fn has_control(&self, id: Id) -> bool {
        self.lock().holder == Some(id)
    }

    /// Whether there are any viewers.
    pub fn has_viewers(&self) -> bool {
        !self.lock().viewers.is_empty()
    }

    /// Takes the queued messages for a viewer, with the picture last. Returns `None` if the queue has exceeded its limit.
    pub fn take(&self, id: Id) -> Option<Vec<Message>> {
        let mut state = self.lock();
        let queue = state.viewers.get_mut(&id)?;
        if queue.is_behind() {
            return None;
        }
        queue.bytes = 0;
        let mut messages: Vec<Message> = queue.messages.drain(..).collect();
        messages.extend(queue.picture.take());
        Some(messages)
    }

    /// Sends a message to all viewers. A message that describes the board's state is kept for later viewers.
    pub fn send(&self, message: &ToPage) {
        let encoded = message.encoded();
        let mut state = self.lock();
        match message {
            ToPage::Board { .. } => state.board = Some(encoded.clone()),
            ToPage::Lists { .. } => state.lists = Some(encoded.clone()),
            ToPage::Pins(_) => state.pins = Some(encoded.clone()),
            ToPage::Console { .. } | ToPage::Control { .. } | ToPage::Sample { .. } => {}
            ToPage::Motion { .. } | ToPage::Help { .. } | ToPage::Completions { .. } => {}
            ToPage::Progress { .. } | ToPage::Notice { .. } => {}
        }
        state.send(&encoded);
    }

    /// Sends the levels of the pins to all viewers.
    pub fn send_pins(&self, pins: Pins) {
        self.send(&ToPage::Pins(pins));
    }

    /// Sends a notice to all viewers.
    pub fn notify(&self, text: impl Into<String>, is_error: bool) {
        let text = text.into();
        self.send(&ToPage::Notice { text, is_error });
    }

    /// Tells all viewers that a transfer has ended early.
    pub fn end_progress(&self) {
        self.send(&ToPage::Progress { done: 0, all: 0 });
    }

    /// Sends a message to one viewer.
    pub fn send_one(&self, id: Id, message: &ToPage) {
        if let Some(queue) = self.lock().viewers.get_mut(&id) {
            queue.push(message.encoded());
        }
    }

    /// Sends an error notice to one viewer.
    pub fn notify_one(&self, id: Id, text: impl Into<String>) {
        let (text, is_error) = (text.into(), true);
        self.send_one(id, &ToPage::Notice { text, is_error });
    }

    /// Sends console output to all viewers.
    pub fn send_console(&self, bytes: &[u8]) {
        let text = String::from_utf8_lossy(bytes).into_owned();
        let mut state = self.lock();
        state.transcript.push_str(&text);
        if state.transcript.len() > 2 * TRANSCRIPT {
            let cut = state.transcript.len() - TRANSCRIPT;
            let cut = state.transcript.ceil_char_boundary(cut);
            state.transcript.drain(..cut);
        }
        state.send(&ToPage::Console { text }.encoded());
    }

    /// Sends a picture to all viewers.
    pub fn show(&self, frame: &Frame) {
        let mut state = self.lock();
        state.pictures = state.pictures.wrapping_add(1);
        let message = picture(frame, state.pictures);
        for queue in state.viewers.values_mut() {
            queue.picture = Some(message.clone());
        }
        state.picture = Some(message);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(colour: u16) -> Frame {
        Frame {
            width: 2,
            height: 1,
            pixels: vec![colour; 2],
        }
    }

    #[test]
    fn old_pictures_are_dropped_and_texts_are_not() {
        let hub = Hub::default();
        hub.show(&frame(1));
        let id = hub.join().unwrap();
        hub.send_console(b"a");
        hub.show(&frame(2));
        hub.send_console(b"b");
        hub.show(&frame(3));
        let messages = hub.take(id).unwrap();
        let text = |message: &Message| match message {
            Message::Text(text) => Some(text.to_string()),
            Message::Binary(_) => None,
        };
        let texts: Vec<_> = messages.iter().filter_map(text).collect();
        assert_eq!(
            &texts[..4],
            [
                r#"{"type":"console","text":""}"#,
                r#"{"type":"control","holder":"you"}"#,
                r#"{"type":"console","text":"a"}"#,
                r#"{"type":"console","text":"b"}"#
            ]
        );
        let expected = Message::Binary([2, 0, 1, 0, 3, 0, 0, 0, 3, 0, 3, 0].into());
        assert_eq!(messages.last(), Some(&expected));
        assert!(hub.take(id).unwrap().is_empty());
    }

    #[test]
    fn one_viewer_has_control() {
        let hub = Hub::default();
        let (first, second) = (hub.join().unwrap(), hub.join().unwrap());
        assert!(hub.has_control(first) && !hub.has_control(second));
        hub.take_control(second);
        hub.release_control(second);
        assert!(hub.has_control(first));
        hub.leave(first);
        hub.take_control(second);
        assert!(hub.has_control(second));
    }

    #[test]
    fn a_viewer_that_falls_behind_is_closed() {
        let hub = Hub::default();
        let id = hub.join().unwrap();
        let line = [b'x'; 1 << 16];
        for _ in 0..65 {
            hub.send_console(&line);
        }
        assert!(hub.lock().viewers[&id].messages.is_empty());
        assert!(hub.take(id).is_none());
    }
}
