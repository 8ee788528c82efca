//! Completion of command names and of words of arguments.

use super::command::{find, syntaxes};
use super::syntax::{Parameter, Shape, WordKind};
use crate::words::{Word, Words};

/// Calls `offer` for each candidate for the last word of `line`. The arguments of `offer` are the whole candidate and its part
/// that the line does not yet contain.
pub fn complete(line: &str, offer: &mut dyn FnMut(&'static str, &'static str)) {
    let words = Words::new(line);
    // After a blank at the end of the line, the word to complete is a new, empty word.
    let ends = line.is_empty() || line.ends_with(' ');
    let count = words.clone().count() + usize::from(ends);
    let begun = words.clone().last().filter(|_| !ends);
    let begun = begun.map_or("", |word: Word| word.text);
    let mut offer = |word: &'static str| {
        if let Some(rest) = word.strip_prefix(begun) {
            offer(word, rest);
        }
    };
    let Some(command) = words.clone().next().filter(|_| count > 1) else {
        return syntaxes().for_each(|syntax| offer(syntax.name));
    };
    let Some(parameter) = parameter(command.text, count - 2) else {
        return;
    };
    match &parameter.shape {
        Shape::Flag => offer(parameter.name),
        Shape::Word(WordKind::Words(words)) => words.iter().for_each(|word| offer(word)),
        &Shape::Word(mut kind @ WordKind::Either(..)) => {
            while let WordKind::Either(keyword, other) = kind {
                offer(keyword);
                kind = other;
            }
        }
        Shape::Word(WordKind::Command) => syntaxes().for_each(|syntax| offer(syntax.name)),
        Shape::Word(WordKind::Text(_)) | Shape::Group(_) => {}
    }
}

/// Returns the parameter of `command` for the word at `index` (from 0) after the command's name.
fn parameter(command: &str, index: usize) -> Option<&'static Parameter> {
    let mut left = index;
    find(command)?
        .visit::<&'static Parameter>(&mut |parameter| {
            left = left.checked_sub(1).ok_or(parameter)?;
            Ok(())
        })
        .err()
}
