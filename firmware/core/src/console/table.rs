//! Macro that generates the grammar and the execution of commands from their table.

/// Defines all commands, grouped by subject:
///
/// ```text
/// commands! {
///     /// Documentation of the subject's trait.
///     SubjectCommands {
///         name Variant(argument: Type, …): "help line";
///     }
/// }
/// ```
///
/// Each `Type` implements [`Argument`](super::argument::Argument). The macro generates the enumeration `Command`, the list
/// `COMMANDS` for parser, help and completion, and a trait per subject with one method per command.
macro_rules! commands {
    ($(
        $(#[$doc:meta])*
        $subject:ident {
            $($name:ident $variant:ident($($argument:ident: $type:ty),* $(,)?): $summary:literal;)+
        }
    )+) => {
        /// A command with its arguments. Each argument is in its range. The state of the machine may still exclude the command; its
        /// handler checks this.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[expect(
            clippy::large_enum_variant,
            reason = "one command exists at a time, and there is no heap"
        )]
        pub enum Command<'a> {
            $($(
                #[doc = concat!("`", stringify!($name), "`: ", $summary, ".")]
                $variant {
                    $(
                        #[doc = concat!("The argument `", stringify!($argument), "`.")]
                        $argument: <$type as Argument>::Value<'a>,
                    )*
                },
            )+)+
        }

        /// All commands, in the order of the help.
        static COMMANDS: &[Entry] = &[$($(
            Entry {
                syntax: Syntax::new(
                    stringify!($name),
                    $summary,
                    const { &[$(Parameter::of::<$type>(stringify!($argument))),*] },
                ),
                read: |_reader| Some(Command::$variant {
                    $($argument: _reader.read::<$type>(const { &Parameter::of::<$type>(stringify!($argument)) })?,)*
                }),
            },
        )+)+];

        $(
            $(#[$doc])*
            pub trait $subject<'a>: Executor<'a> {
                $(
                    #[doc = concat!("`", stringify!($name), "`: ", $summary, ".")]
                    fn $name(&mut self, $($argument: <$type as Argument>::Value<'a>),*) -> Self::Output;
                )+
            }
        )+

        impl<'a> Command<'a> {
            /// Executes the command: calls the method of `executor` that has the command's name.
            pub fn execute<E: $($subject<'a> +)+>(self, executor: &mut E) -> E::Output {
                match self {
                    $($(
                        Self::$variant { $($argument),* } => executor.$name($($argument),*),
                    )+)+
                }
            }
        }
    };
}
pub(super) use commands;
