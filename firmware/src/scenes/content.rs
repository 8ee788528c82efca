//! Content of scenes and lists.

/// Content of a scene or a list.
#[derive(Clone, Copy, Debug)]
pub enum Content {
    /// The console commands, one per line, that set up the picture and start camera motion, starting from the default scene.
    Lines(&'static str),
    /// The names of other scenes; lists do not nest.
    Scenes(List),
}

/// The names of a list of scenes.
#[derive(Clone, Copy, Debug)]
pub enum List {
    /// A list in the flash: a text with one name per line.
    Flash(&'static str),
    /// A list in the firmware: the names.
    BuiltIn(&'static [&'static str]),
}

impl List {
    /// Number of scenes.
    pub fn len(&self) -> usize {
        match self {
            Self::Flash(names) => names.lines().count(),
            Self::BuiltIn(names) => names.len(),
        }
    }

    /// The name of a scene by its number, from 0.
    pub fn name(&self, number: usize) -> Option<&'static str> {
        match self {
            Self::Flash(names) => names.lines().nth(number),
            Self::BuiltIn(names) => names.get(number).copied(),
        }
    }
}
