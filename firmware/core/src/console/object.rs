//! The argument of the command `object`.

use super::argument::{Argument, Keyword, Or, Reader};
use super::error::ValueError;
use super::syntax::{NameList, Parameter, Shape, WordKind};
use super::values::{MeshName, Whole};
use crate::choice::choices;
use crate::object::{MAX_OBJECTS, Operation, Place, PlaceError};

/// An action of the command `object`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ObjectAction<'a> {
    /// List the objects with their numbers and placements.
    List,
    /// Show the objects in the picture, in place of a mesh or a field.
    Show,
    /// Add an object at the end of the list.
    Add {
        /// Name of the mesh.
        mesh: &'a str,
        /// Placement and colour of the mesh.
        place: Place,
    },
    /// Move, rotate, scale or colour an object, or multiply it by a matrix.
    Change {
        /// Number of the object, from 1.
        number: u32,
        /// The operation to append to the object's operations, or the object's new colour.
        next: Place,
    },
    /// Remove the object with this number, from 1; `None` removes all objects.
    Remove(Option<u32>),
}

/// The first word of an [`ObjectAction`].
#[derive(Clone, Copy)]
enum Action {
    List,
    Show,
    Add,
    Move,
    Rotate,
    Scale,
    Matrix,
    Colour,
    Remove,
}

choices!(Action {
    List: "list",
    Show: "show",
    Add: "add",
    Move: "move",
    Rotate: "rotate",
    Scale: "scale",
    Matrix: "matrix",
    Colour: "colour",
    Remove: "remove",
});

/// The keyword `all`.
struct All;

impl Keyword for All {
    const WORD: &'static str = "all";
}

/// The number of an object.
type Number = Whole<{ MAX_OBJECTS as u32 }>;

/// The action of the command `object`, with the words that this action needs.
pub struct Object;

static ACTION: Parameter = Parameter::of::<Action>("action");
static MESH: Parameter = Parameter::of::<MeshName>("mesh");
static NUMBER: Parameter = Parameter::of::<Number>("number");
static REMOVED: Parameter = Parameter::of::<Or<All, Number>>("number");

impl Argument for Object {
    type Value<'a> = ObjectAction<'a>;
    const SHAPE: Shape = Shape::group(
        const {
            &[
                Parameter::of::<Action>("action"),
                Parameter {
                    name: "object",
                    optional: true,
                    shape: Shape::group(
                        const {
                            &[
                                Parameter {
                                    name: "object",
                                    optional: false,
                                    shape: Shape::Word(&WordKind::Name(
                                        NameList::Meshes,
                                        &"a mesh after add, and the number of an object after other actions",
                                    )),
                                },
                                Parameter {
                                    name: "place",
                                    optional: true,
                                    shape: Shape::Word(&WordKind::Text(
                                        &"X,Y,Z to move, AXIS DEGREES to rotate, S or X,Y,Z to scale, 9 or 12 numbers of a \
                                          matrix, RRGGBB of a colour; after add, operations such as `scale 0.5 rotate z 30 move 1,0,0`",
                                    )),
                                },
                            ]
                        },
                    ),
                },
            ]
        },
    );

    #[inline(never)]
    fn read<'a>(reader: &mut Reader<'a>, _: &'static Parameter) -> Option<ObjectAction<'a>> {
        let change = match reader.read::<Action>(&ACTION)? {
            Action::List => return Some(ObjectAction::List),
            Action::Show => return Some(ObjectAction::Show),
            Action::Add => {
                let mesh = reader.read::<MeshName>(&MESH)?;
                let place = Place::parse(reader.words());
                let place = accepted(reader, place)?;
                return Some(ObjectAction::Add { mesh, place });
            }
            Action::Remove => {
                let number = reader.read::<Or<All, Number>>(&REMOVED)?;
                return Some(ObjectAction::Remove(number));
            }
            Action::Move => Operation::Move,
            Action::Rotate => Operation::Rotate,
            Action::Scale => Operation::Scale,
            Action::Matrix => Operation::Matrix,
            Action::Colour => Operation::Colour,
        };
        let number = reader.read::<Number>(&NUMBER)?;
        let next = Place::of(change, reader.words());
        let next = accepted(reader, next)?;
        Some(ObjectAction::Change { number, next })
    }
}

/// Returns the placement if it is valid; otherwise stores the error in `reader` and returns `None`.
fn accepted<'a>(reader: &mut Reader<'a>, place: Result<Place, PlaceError<'a>>) -> Option<Place> {
    place
        .map_err(|error| reader.reject(ValueError::Place(error)))
        .ok()
}
