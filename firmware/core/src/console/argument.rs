//! Types of command arguments: how the words of a line are parsed into values.

use core::marker::PhantomData;

use super::error::{ParseError, ParseErrorKind, ValueError};
use super::syntax::{Parameter, Shape, Syntax, WordKind};
use crate::choice::Choice;
use crate::words::{Word, Words};

/// A type of command argument, which takes one or several words of a line.
pub trait Argument {
    /// Type of the value that the argument's words are parsed to.
    type Value<'a>;
    /// Whether the argument may be missing at the end of the line.
    const OPTIONAL: bool = false;
    /// The words that the argument consists of.
    const SHAPE: Shape;

    /// Takes the argument's words from `reader` and returns their value. `None` means an error, which `reader` stores.
    fn read<'a>(reader: &mut Reader<'a>, parameter: &'static Parameter) -> Option<Self::Value<'a>>;
}

/// A type of argument that takes one word.
pub trait WordArgument {
    /// Type of the value that the word is parsed to.
    type Value<'a>;
    /// The texts that are accepted as the word.
    const KIND: WordKind;

    /// Parses a word. `None` means that the word is not accepted.
    fn parse(text: &str) -> Option<Self::Value<'_>>;

    /// Returns the reason why [`parse`](Self::parse) rejects a word; `None` if the only reason is that the word is not of this type.
    fn error(_: &str) -> Option<ValueError<'_>> {
        None
    }
}

/// Reads the words of a line after the command's name, and stores the first error.
///
/// The reader stores the error, so that the many small functions that read arguments can return `Option` instead of `Result`;
/// this reduces code size.
pub struct Reader<'a> {
    syntax: &'static Syntax,
    words: Words<'a>,
    word: Word<'a>,
    error: Option<ParseError<'a>>,
}

impl<'a> Reader<'a> {
    /// Reads the arguments in `words` for a command with this syntax and name.
    pub const fn new(syntax: &'static Syntax, name: Word<'a>, words: Words<'a>) -> Self {
        Self {
            syntax,
            words,
            word: name,
            error: None,
        }
    }

    /// Reads the value of one parameter. `None` means an error, which the reader stores.
    pub fn read<T: Argument>(&mut self, parameter: &'static Parameter) -> Option<T::Value<'a>> {
        T::read(self, parameter)
    }

    /// Returns whether all words of the line were read.
    #[inline(never)]
    pub fn is_empty(&self) -> bool {
        self.words.clone().next().is_none()
    }

    /// Takes the next word; at the end of the line, stores the error that `parameter` is missing.
    #[inline(never)]
    fn word(&mut self, parameter: &'static Parameter) -> Option<&'a str> {
        let syntax = self.syntax;
        if let Some(word) = self.words.next() {
            self.word = word;
            return Some(word.text);
        }
        self.error = Some(ParseError(ParseErrorKind::Missing { syntax, parameter }));
        None
    }

    /// The remaining words, for an argument with a parser of its own.
    pub const fn words(&mut self) -> &mut Words<'a> {
        &mut self.words
    }

    /// Rejects the last word that was taken: stores the error that `error_of` returns for this word, or else that the word is not
    /// accepted for `parameter`.
    #[cold]
    #[inline(never)]
    fn reject_word(&mut self, parameter: &'static Parameter, error_of: ErrorOf) {
        let Self { syntax, word, .. } = *self;
        self.error = Some(ParseError(match error_of(word.text) {
            Some(error) => ParseErrorKind::Value { syntax, error },
            None => ParseErrorKind::Word {
                syntax,
                parameter,
                word,
            },
        }));
    }

    /// Rejects a combination of valid words: stores `error`.
    #[cold]
    #[inline(never)]
    pub fn reject(&mut self, error: ValueError<'a>) {
        let syntax = self.syntax;
        self.error = Some(ParseError(ParseErrorKind::Value { syntax, error }));
    }

    /// Checks that all arguments were accepted and all words were read.
    ///
    /// # Errors
    /// An argument was rejected, or the line has surplus words.
    pub fn end(mut self) -> Result<(), ParseError<'a>> {
        let syntax = self.syntax;
        if let Some(error) = self.error {
            return Err(error);
        }
        match self.words.next() {
            Some(word) => Err(ParseError(ParseErrorKind::Surplus { syntax, word })),
            None => Ok(()),
        }
    }
}

/// The signature of [`WordArgument::error`], which returns the reason why a word is rejected.
type ErrorOf = fn(&str) -> Option<ValueError<'_>>;

impl Parameter {
    /// Makes a parameter with this name that takes an argument of type `T`.
    pub const fn of<T: Argument>(name: &'static str) -> Self {
        Self {
            name,
            optional: T::OPTIONAL,
            shape: T::SHAPE,
        }
    }
}

impl<T: WordArgument> Argument for T {
    type Value<'a> = T::Value<'a>;
    const SHAPE: Shape = Shape::Word(&T::KIND);

    // Not inlined, so that all commands share one copy for each type of argument.
    #[inline(never)]
    fn read<'a>(reader: &mut Reader<'a>, parameter: &'static Parameter) -> Option<Self::Value<'a>> {
        let value = T::parse(reader.word(parameter)?);
        if value.is_none() {
            reader.reject_word(parameter, T::error);
        }
        value
    }
}

/// An optional argument: the line may end before it.
impl<T: Argument> Argument for Option<T> {
    type Value<'a> = Option<T::Value<'a>>;
    const OPTIONAL: bool = true;
    const SHAPE: Shape = T::SHAPE;

    fn read<'a>(reader: &mut Reader<'a>, parameter: &'static Parameter) -> Option<Self::Value<'a>> {
        if reader.is_empty() {
            return Some(None);
        }
        T::read(reader, parameter).map(Some)
    }
}

/// An optional keyword, which is the parameter's own name. The value states whether the keyword is present.
pub struct Flag;

impl Argument for Flag {
    type Value<'a> = bool;
    const OPTIONAL: bool = true;
    const SHAPE: Shape = Shape::Flag;

    fn read<'a>(reader: &mut Reader<'a>, parameter: &'static Parameter) -> Option<bool> {
        if reader.is_empty() {
            return Some(false);
        }
        if reader.word(parameter)? == parameter.name {
            return Some(true);
        }
        reader.reject_word(parameter, |_| None);
        None
    }
}

/// Defines the argument type `Name` of several words: `group!(Name: Value = (word: Type, …) => expression)`. The expression
/// computes the value from the parsed words, which are variables with these names. The type of the expression is a `Result` with
/// a [`ValueError`].
macro_rules! group {
    ($(#[$doc:meta])* $name:ident: $value:ty = ($($word:ident: $type:ty),+ $(,)?) => $build:expr) => {
        $(#[$doc])*
        pub struct $name;

        impl Argument for $name {
            type Value<'a> = $value;
            const SHAPE: Shape = Shape::group(const { &[$(Parameter::of::<$type>(stringify!($word))),+] });

            fn read<'a>(
                reader: &mut Reader<'a>,
                _: &'static Parameter,
            ) -> Option<$value> {
                $(let $word = reader.read::<$type>(const { &Parameter::of::<$type>(stringify!($word)) })?;)+
                match $build {
                    Ok(value) => Some(value),
                    Err(error) => {
                        reader.reject(error);
                        None
                    }
                }
            }
        }
    };
}
pub(super) use group;

/// An argument of one word: the name of a value of a type that implements [`Choice`].
impl<T: Choice> WordArgument for T {
    type Value<'a> = T;
    const KIND: WordKind = WordKind::Words(T::WORDS);

    fn parse(text: &str) -> Option<T> {
        T::from_word(text)
    }
}

/// A keyword that may replace a value.
pub trait Keyword {
    /// The text of the keyword.
    const WORD: &'static str;
}

/// The keyword `off`.
pub struct Off;

impl Keyword for Off {
    const WORD: &'static str = "off";
}

/// The keyword `default`.
pub struct Default;

impl Keyword for Default {
    const WORD: &'static str = "default";
}

/// The keyword `own`.
pub struct Own;

impl Keyword for Own {
    const WORD: &'static str = OWN;
}

/// The keyword that selects the textures of the meshes themselves.
pub const OWN: &str = "own";

/// An argument that is either the keyword `K`, whose value is `None`, or a word of type `T`.
pub struct Or<K, T>(PhantomData<(K, T)>);

impl<K: Keyword, T: WordArgument> WordArgument for Or<K, T> {
    type Value<'a> = Option<T::Value<'a>>;
    const KIND: WordKind = WordKind::Either(K::WORD, &T::KIND);

    fn parse(text: &str) -> Option<Self::Value<'_>> {
        if text == K::WORD {
            return Some(None);
        }
        T::parse(text).map(Some)
    }

    fn error(text: &str) -> Option<ValueError<'_>> {
        T::error(text)
    }
}
