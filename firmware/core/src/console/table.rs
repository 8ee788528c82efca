//! Macro that generates the grammar and the execution of commands from their table.

/// Defines all commands, grouped by subject, and the options of a scene:
///
/// ```text
/// commands! {
///     /// Documentation of the subject's trait.
///     SubjectCommands {
///         name Variant(argument: Type, …) in FEATURE: "help line" => forms;
///     }
///     options {
///         name Variant(argument: Type, …) or show in FEATURE: "help line" => forms;
///     }
/// }
/// ```
///
/// Each `Type` implements [`Argument`](super::argument::Argument). A build without the [feature](crate::feature) leaves the command out;
/// a command without `in FEATURE` is in every build. An option with `or show` is shown if the line ends after its name. The
/// [`Forms`](super::forms::Forms) define the key of scene files and the option of `glint` that correspond to the command.
///
/// The macro generates the enumerations `Command`, `Setting` and `OptionName`, the list `COMMANDS` for parser, help and completion, the
/// list `FORMS`, and a trait per subject with one method per command.
macro_rules! commands {
    ($(
        $(#[$doc:meta])*
        $subject:ident {
            $($name:ident $variant:ident($($argument:ident: $type:ty),* $(,)?) $(in $feature:ident)?: $summary:literal $(=> $forms:expr)?;)+
        }
        options {
            $($option:ident $value:ident($($part:ident: $form:ty),+ $(,)?) $(or $shown:ident)? $(in $of:ident)?: $help:literal $(=> $stated:expr)?;)*
        }
    )+) => {
        /// A command with its arguments. All arguments are in their ranges. The handler of the command checks whether the state
        /// of the machine permits the command.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[expect(
            clippy::large_enum_variant,
            reason = "one command exists at a time, and there is no heap"
        )]
        pub enum Command<'a> {
            /// Sets an option of the scene.
            Set(Setting<'a>),
            /// Shows an option of the scene.
            Show(OptionName),
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

        /// An option of the scene with its new value.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[expect(
            clippy::large_enum_variant,
            reason = "one command exists at a time, and there is no heap"
        )]
        pub enum Setting<'a> {
            $($(
                #[doc = concat!("`", stringify!($option), "`: ", $help, ".")]
                $value {
                    $(
                        #[doc = concat!("The argument `", stringify!($part), "`.")]
                        $part: <$form as Argument>::Value<'a>,
                    )+
                },
            )*)+
        }

        /// An option of the scene.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum OptionName {
            $($(
                #[doc = concat!("`", stringify!($option), "`.")]
                $value,
            )*)+
        }

        impl OptionName {
            /// All options, in the order of the help.
            pub const ALL: &'static [Self] = &[$($(Self::$value,)*)+];

            /// The option's name on the console.
            pub const fn name(self) -> &'static str {
                match self {
                    $($(Self::$value => stringify!($option),)*)+
                }
            }
        }

        /// All commands, in the order of the help.
        static COMMANDS: &[Entry] = &[$(
            $(
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
            )+
            $(
                if part!($($of)?).is_built {
                    Entry::Built {
                        syntax: Syntax::new(
                            stringify!($option),
                            $help,
                            const { &[$(Parameter::of::<$form>(stringify!($part))),+] },
                        )
                        .or_show(shows!($($shown)?)),
                        read: |reader| {
                            if shows!($($shown)?) && reader.is_empty() {
                                return Some(Command::Show(OptionName::$value));
                            }
                            Some(Command::Set(Setting::$value {
                                $($part: reader.read::<$form>(const { &Parameter::of::<$form>(stringify!($part)) })?,)+
                            }))
                        },
                    }
                } else {
                    Entry::LeftOut {
                        name: stringify!($option),
                        feature: part!($($of)?),
                    }
                },
            )*
        )+];

        /// The keys and options that correspond to commands, in the order of the help.
        pub static FORMS: &[Row] = &[$(
            $($(Row { command: stringify!($name), forms: $forms },)?)+
            $($(Row { command: stringify!($option), forms: $stated },)?)*
        )+];

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
            /// Executes the command: calls the method of `executor` with the command's name, or the common method of all options.
            pub fn execute<E: $($subject<'a> +)+>(self, executor: &mut E) -> E::Output {
                match self {
                    Self::Set(setting) => executor.set(setting),
                    Self::Show(option) => executor.show(option),
                    $($(
                        Self::$variant { $($argument),* } => {
                            // The parser returns only commands of this build; the condition lets the compiler remove the call.
                            if part!($($feature)?).is_built {
                                executor.$name($($argument),*)
                            } else {
                                executor.left_out(part!($($feature)?))
                            }
                        }
                    )+)+
                }
            }

            /// The feature that contains the command.
            pub const fn feature(&self) -> Feature {
                match self {
                    Self::Set(setting) => setting.name().feature(),
                    Self::Show(option) => option.feature(),
                    $($(Self::$variant { .. } => part!($($feature)?),)+)+
                }
            }
        }

        impl Setting<'_> {
            /// The option that this setting changes.
            pub const fn name(&self) -> OptionName {
                match self {
                    $($(Self::$value { .. } => OptionName::$value,)*)+
                }
            }
        }

        impl OptionName {
            /// The feature that contains the option.
            pub const fn feature(self) -> Feature {
                match self {
                    $($(Self::$value => part!($($of)?),)*)+
                }
            }
        }
    };
}

/// Whether an option can be shown: `true` for the entry `or show` of the table.
macro_rules! shows {
    () => {
        false
    };
    (show) => {
        true
    };
}

/// The feature with this name; without a name, the feature that every build has.
macro_rules! part {
    () => {
        $crate::feature::BASE
    };
    ($feature:ident) => {
        $crate::feature::$feature
    };
}
pub(super) use {commands, part, shows};
