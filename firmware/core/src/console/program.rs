//! The argument of the command `program`.

use super::argument::{Argument, Reader};
use super::syntax::{NameList, Parameter, Shape, WordKind};
use super::values::{MeshName, Upload, UploadName};
use crate::wire::Manifest;

/// An action of the command `program`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProgramAction<'a> {
    /// Show the program with this name.
    Show(&'a str),
    /// Upload a program, and show it.
    Upload {
        /// Length and checksum.
        manifest: Manifest,
        /// Name of the upload; `None` for the default name.
        name: Option<&'a str>,
    },
}

/// The action of the command `program`: a single word is the name of a program, and several words announce an upload.
pub struct Program;

static NAME: Parameter = Parameter::of::<MeshName>("name");
static UPLOAD: Parameter = Parameter::of::<Upload>("upload");
static UPLOAD_NAME: Parameter = Parameter::of::<UploadName>("name");

impl Argument for Program {
    type Value<'a> = ProgramAction<'a>;
    const SHAPE: Shape = Shape::group(
        const {
            &[
                Parameter {
                    name: "name|bytes",
                    optional: false,
                    shape: Shape::Word(&WordKind::Name(
                        NameList::Programs,
                        &"the name of a program, or the length of an upload in bytes",
                    )),
                },
                Parameter {
                    name: "upload",
                    optional: true,
                    shape: Shape::group(
                        const {
                            &[
                                Parameter {
                                    name: "crc32",
                                    optional: false,
                                    shape: Shape::Word(&WordKind::Text(
                                        &"up to 8 hexadecimal digits: the checksum of an upload",
                                    )),
                                },
                                Parameter::of::<Option<UploadName>>("name"),
                            ]
                        },
                    ),
                },
            ]
        },
    );

    #[inline(never)]
    fn read<'a>(reader: &mut Reader<'a>, _: &'static Parameter) -> Option<ProgramAction<'a>> {
        if reader.words().clone().count() == 1 {
            return reader.read::<MeshName>(&NAME).map(ProgramAction::Show);
        }
        let manifest = reader.read::<Upload>(&UPLOAD)?;
        let name = reader.read::<Option<UploadName>>(&UPLOAD_NAME)?;
        Some(ProgramAction::Upload { manifest, name })
    }
}
