//! Macro that generates the grammar and the execution of commands from their table.

/// Defines all commands, grouped by subject:
///
/// ```text
/// commands! {
///     /// Documentation of the subject's trait.
///     SubjectCommands {
///         name Variant(argument: Type, …) in FEATURE: "help line";
///     }
/// }
/// ```
///
/// Each `Type` implements [`Argument`](super::argument::Argument). A build without the [feature](crate::feature) leaves the command out;
/// a command without `in FEATURE` is in every build. The macro generates the enumeration `Command`, the list
/// `COMMANDS` for parser, help and completion, and a trait per subject with one method per command.
macro_rules! commands {
    ($(
        $(#[$doc:meta])*
        $subject:ident {
            $($name:ident $variant:ident($($argument:ident: $type:ty),* $(,)?) $(in $feature:ident)?: $summary:literal;)+
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
            if part!($($feature)?).is_built {
                Entry::Built {
                    syntax: Syntax::new(
                        stringify!($name),
                        $summary,
                        const { &[$(Parameter::of::<$type>(stringify!($argument))),*] },
                    ),
                    read: |_reader| Some(Command::$variant {
                        $($argument: _reader.read::<$type>(const { &Parameter::of::<$type>(stringify!($argument)) })?,)*
                    }),
                }
            } else {
                Entry::LeftOut {
                    name: stringify!($name),
                    feature: part!($($feature)?),
                }
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
                        Self::$variant { $($argument),* } if part!($($feature)?).is_built => {
                            executor.$name($($argument),*)
                        }
                    )+)+
                    // The parser makes no other commands.
                    _ => executor.left_out(self.feature()),
                }
            }

            /// The part of the firmware that has the command.
            pub const fn feature(&self) -> Feature {
                match self {
                    $($(Self::$variant { .. } => part!($($feature)?),)+)+
                }
            }
        }
    };
}

/// The part of the firmware with this name, or the one of every build.
macro_rules! part {
    () => {
        $crate::feature::BASE
    };
    ($feature:ident) => {
        $crate::feature::$feature
    };
}
pub(super) use {commands, part};
