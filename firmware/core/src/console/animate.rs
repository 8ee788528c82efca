//! The argument of the command `animate`.

use super::argument::{Argument, Off, Or, Reader, WordArgument};
use super::syntax::{Parameter, Shape, WordKind};
use super::values::Whole;
use crate::animation::{Animation, ObjectTurn, Part, Rate};
use crate::choice::Choice as _;
use crate::fixed::Q32_32;
use crate::matrix::Axis;
use crate::object::MAX_OBJECTS;

/// A rate in degrees a second.
impl WordArgument for Rate {
    type Value<'a> = Self;
    const KIND: WordKind = WordKind::Text(&"degrees a second, from -360 to 360");

    fn parse(text: &str) -> Option<Self> {
        Self::new(<Q32_32 as WordArgument>::parse(text)?)
    }
}

/// The word after `turn`: an axis, or the number of an object, after which an axis follows.
enum Turned {
    Axis(Axis),
    Object(u32),
}

impl WordArgument for Turned {
    type Value<'a> = Self;
    const KIND: WordKind = WordKind::Text(&"an axis x, y or z, or the number of an object");

    fn parse(text: &str) -> Option<Self> {
        let number = || <Whole<{ MAX_OBJECTS as u32 }, 1>>::parse(text).map(Self::Object);
        Axis::from_word(text).map(Self::Axis).or_else(number)
    }
}

/// Parts and their rates.
pub struct Animate;

static FIRST: Parameter = Parameter::of::<Or<Off, Part>>("part");
static NEXT: Parameter = Parameter::of::<Part>("part");
static RATE: Parameter = Parameter::of::<Rate>("rate");
static TURNED: Parameter = Parameter::of::<Turned>("axis");
static AXIS: Parameter = Parameter::of::<Axis>("axis");

impl Argument for Animate {
    type Value<'a> = Animation;
    const SHAPE: Shape = Shape::group(
        const {
            &[
                Parameter::of::<Or<Off, Part>>("part"),
                Parameter {
                    name: "rate",
                    optional: true,
                    shape: Shape::Word(&WordKind::Text(
                        &"degrees a second, from -360 to 360; after turn, AXIS RATE or NUMBER AXIS RATE (one object); then further parts",
                    )),
                },
            ]
        },
    );

    #[inline(never)]
    fn read<'a>(reader: &mut Reader<'a>, _: &'static Parameter) -> Option<Animation> {
        let mut animation = Animation::default();
        let mut next = reader.read::<Or<Off, Part>>(&FIRST)?;
        while let Some(part) = next {
            match part {
                Part::Azimuth => animation.azimuth = reader.read::<Rate>(&RATE)?,
                Part::Orbit => animation.orbit = reader.read::<Rate>(&RATE)?,
                Part::Turn => {
                    let (object, axis) = match reader.read::<Turned>(&TURNED)? {
                        Turned::Axis(axis) => (None, axis),
                        Turned::Object(number) => (Some(number), reader.read::<Axis>(&AXIS)?),
                    };
                    let rate = reader.read::<Rate>(&RATE)?;
                    let turn = ObjectTurn { object, axis, rate };
                    animation.turn = Some(turn).filter(|turn| !turn.rate.is_zero());
                }
            }
            next = reader.read::<Option<Part>>(&NEXT)?;
        }
        Some(animation)
    }
}
