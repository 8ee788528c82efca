//! Completion of command names, of words of arguments, and of the machine's names.

use super::command::{find, syntaxes};
use super::syntax::{Names, Parameter, Shape, WordKind};
use crate::words::{Word, Words};

/// Calls `offer` with each completion of the last word of `line`; `names` are the names of the machine's scenes, meshes, textures and
/// programs. The arguments of `offer` are the whole completion and its part that the line does not yet contain.
pub fn complete(line: &str, names: &dyn Names, offer: &mut dyn FnMut(&str, &str)) {
    let words = Words::new(line);
    // After a blank at the end of the line, the word to complete is a new, empty word.
    let ends = line.is_empty() || line.ends_with(' ');
    let count = words.clone().count() + usize::from(ends);
    let begun = words.clone().last().filter(|_| !ends);
    let begun = begun.map_or("", |word: Word| word.text);
    let mut offer = |word: &str| {
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
    match parameter.shape {
        Shape::Flag => offer(parameter.name),
        Shape::Word(kind) => offer_words(kind, names, &mut offer),
        Shape::Group(_) => {}
    }
}

/// Calls `offer` with each word of a kind.
fn offer_words(kind: &WordKind, names: &dyn Names, offer: &mut dyn FnMut(&str)) {
    match kind {
        WordKind::Words(words) => words.iter().for_each(|word| offer(word)),
        WordKind::Either(keyword, other) => {
            offer(keyword);
            offer_words(other, names, offer);
        }
        WordKind::Command => syntaxes().for_each(|syntax| offer(syntax.name)),
        WordKind::Name(list, _) => names.visit(*list, offer),
        WordKind::Forms(forms) => forms.iter().for_each(|(form, _)| {
            // The name with the colon, if numbers follow.
            offer(form.split_inclusive(':').next().unwrap_or_default());
        }),
        WordKind::Text(_) => {}
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
