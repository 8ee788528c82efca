//! The table of all commands, and the parser of lines.

use core::fmt;

use super::argument::{Argument, Default, Flag, Off, Or, Reader, WordArgument};
use super::error::{ParseError, ParseErrorKind};
use super::object::Object;
use super::syntax::{Kind, Parameter, Syntax};
use super::table::{commands, part};
use super::values::{
    Benchmark, DemoAction, FieldOfView, Fit, GestureAction, HalfTurn, Imu, LookAt, MeshName,
    Mounting, Name, Sensitivity, Size, Upload, View, Whole,
};
use crate::colour::{Shading, Winding};
use crate::feature::Feature;
use crate::field::Field;
use crate::fixed::{Q32_32, Turns, U4_28, U8_28};
use crate::light::{Background, Light, Material, Rgb};
use crate::picture::{Backend, Edges};
use crate::quality::Quality;
use crate::stereo::Stereo;
use crate::wireframe::Key;
use crate::words::Words;

/// A machine that executes commands. Each trait that the table below defines extends this trait, and has one method per command.
pub trait Executor<'a> {
    /// The result of a command. It may borrow from the line.
    type Output;

    /// The result of a command that this build leaves out. [`Command::parse`] refuses such a command.
    fn left_out(&mut self, feature: Feature) -> Self::Output;
}

commands! {
    /// Commands of the machine and its devices.
    MachineCommands {
        help Help(command: Option<CommandName>): "list the commands, or explain one";
        info Info(key: Option<Name>): "show the state of the machine, or one entry of it";
        selftest SelfTest(): "test clock, memory, sensors, scan-out, and a picture of every engine against its stored checksum";
        echo Echo(word: Name): "print a word; a program finds the end of earlier output by it";
        leds Leds(value: u16): "set the 16 LEDs";
        buttons Buttons(): "show buttons and switches";
        reboot Reboot(): "reset the SoC";
    }

    /// Commands of the scene: mesh, field and wireframe.
    SceneCommands {
        scene Scene(name: Option<Name>): "list meshes and scenes, or show one; a scene sets everything that the picture depends on";
        load Load(upload: Upload, name: Option<MeshName>) in UPLOAD: "upload a mesh (binary) under a name (default model) and show it";
        models Models() in UPLOAD: "list the meshes and the memory for uploads";
        unload Unload(name: MeshName) in UPLOAD: "remove an uploaded mesh";
        program Program(upload: Option<Upload>) in WIREFRAME: "upload a wireframe program (binary) and show it; alone: show the last one";
        press Press(key: Key, rotate: Flag) in WIREFRAME: "press a key of the wireframe for one frame: arrows pan, or rotate; zooms move along z";
        field Field(field: Option<Or<Off, Field>>) in FIELD: "show or set the distance field; off shows the mesh";
        mesh Mesh(on: Option<bool>) in MESH_IN_FIELD: "turn the mesh in a field on or off, or show the setting";
        stereo Stereo(eyes: Option<Or<Off, Stereo>>) in STEREO: "show or set two eyes: E to each side of the camera, zero parallax at ZERO; off is one eye";
        demo Demo(action: Option<DemoAction>) in DEMO: "show the scenes of the flash's first list, or of the built-in list demo, in turn";
    }

    /// Commands of objects: several meshes in a frame, each with its own position.
    ObjectCommands {
        object Object(action: Option<Object>) in OBJECT: "list or show the objects, add one, change its place or colour, or remove it";
    }

    /// Commands of a field's appearance, and of light and background of meshes.
    AppearanceCommands {
        material Material(material: Option<Material>) in FIELD: "show or set the material of a field; normal colours faces by direction";
        light Light(light: Option<Or<Default, Light>>) in LIGHT: "show the lights, add one by its direction or at the camera, or restore the default";
        ambient Ambient(colour: Option<Or<Default, Rgb>>) in LIGHT: "show or set the ambient light";
        background Background(background: Option<Or<Default, Background>>): "show or set the background; default is white for a field and black for meshes, which have one colour";
        fog Fog(density: Option<Or<Off, U4_28>>) in FOG: "show or set the fog of a field: transmittance is exp(-distance * DENSITY)";
        occlusion Occlusion(on: Option<bool>) in FIELD: "turn ambient occlusion of a field on or off, or show the setting";
        undecided Undecided(on: Option<bool>) in FIELD: "turn magenta for rays at the step limit of a field on or off, or show the setting";
    }

    /// Commands of the camera.
    CameraCommands {
        camera Camera(r: Q32_32, theta: Turns, phi: HalfTurn): "face the origin from distance R (2 to 5), azimuth THETA, angle PHI from the z axis";
        view View(view: Option<View>): "show or set the camera: eye, basis (right, down, forward), half width, near plane, projection";
        look Look(yaw: Turns, pitch: Turns, roll: Turns): "turn the camera in place: YAW to the right, PITCH down, ROLL about the view direction";
        lookat LookAt(view: LookAt): "look from an eye in the direction of a gaze, with z or another direction up on the screen";
        fov FieldOfView(angle: FieldOfView): "set a perspective projection by its horizontal field of view, in degrees";
        orthographic Orthographic(width: U8_28): "set an orthographic projection by the picture's WIDTH in world units (0.0174 to 230); fov sets perspective";
        zoom Zoom(factor: U8_28): "enlarge the picture about its middle by FACTOR; below 1 shows more";
        fit Fit(lens: Option<Fit>) in FIT: "show the whole mesh, or all objects, with an axis up on the screen (default z) and a field of view";
        orbit Orbit(frames: Option<Whole<3_600>>): "turn the camera once about the z axis, in FRAMES frames (default 240)";
    }

    /// Commands of the motion sensor (IMU).
    ImuCommands {
        imu Imu(action: Option<Imu>) in IMU: "show sensor status; calibrate, stream, or steer the camera";
        mounting Mounting(mounting: Option<Mounting>) in IMU: "show or set the sensor axes that point into the scene and up on the screen";
        sensitivity Sensitivity(gain: Option<Sensitivity>) in IMU: "show or set camera gain (0.125 to 8)";
        replay Replay(upload: Option<Upload>) in REPLAY: "upload a log (binary) and compute its attitudes, or download the last attitudes (binary)";
    }

    /// Commands of the hand in front of the image sensor.
    GestureCommands {
        gesture Gesture(action: Option<GestureAction>) in GESTURE: "show what the hand does; let it steer the camera, calibrate its colour, or send its mask (binary)";
    }

    /// Commands for drawing frames.
    FrameCommands {
        quality Quality(quality: Option<Quality>): "show or set the quality: the picture size, and the precision of a field's rays";
        size Size(size: Size): "set the picture size: 320 180, 640 360 or 1280 720";
        backend Backend(backend: Option<Backend>): "show or set the backend that draws frames";
        shading Shading(shading: Option<Shading>) in MESH: "show or set the shading: flat (one colour per triangle) or smooth (interpolated)";
        cull Cull(on: bool) in MESH: "turn culling of back faces on or off";
        clip Clip(far: Or<Off, U8_28>) in MESH: "clip triangles to the picture and a far plane at distance FAR; off clips to the guard band";
        winding Winding(rule: Winding) in MESH: "set the rule for the seen side of a triangle: mesh (order of its vertices) or screen (all are seen)";
        edges Edges(edges: Option<Or<Off, Edges>>) in EDGES: "show or set the edges of a mesh alone: hidden (by faces, which are not drawn) or over the shaded faces";
        overlay Overlay(on: Option<bool>) in OVERLAY: "turn the text over the picture on or off, or show the setting";
        prepass Prepass(on: bool) in PREPASS: "turn the cone prepass of a field on or off";
        render Render(depth: Flag): "draw the frame again and show its statistics; depth also writes depth codes";
        frame Frame(depth: Flag): "download the last frame (binary): colour or depth codes";
        stats Stats(json: Flag): "show statistics of the last frame";
        bench Bench(benchmark: Option<Benchmark>) in BENCH: "measure all kernels in clock cycles, or one; triangle and field draw FRAMES frames (default 8)";
    }
}

/// A function that reads the arguments of a command. `None` means an error, which the reader stores.
type Read = for<'a> fn(&mut Reader<'a>) -> Option<Command<'a>>;

/// An entry of the table.
enum Entry {
    /// A command of this build: its syntax, and the function that reads its arguments.
    Built { syntax: Syntax, read: Read },
    /// A command that this build leaves out, and the feature that has it.
    LeftOut {
        name: &'static str,
        feature: Feature,
    },
}

impl Entry {
    const fn name(&self) -> &'static str {
        match self {
            Self::Built { syntax, .. } => syntax.name,
            Self::LeftOut { name, .. } => name,
        }
    }

    const fn syntax(&self) -> Option<&Syntax> {
        match self {
            Self::Built { syntax, .. } => Some(syntax),
            Self::LeftOut { .. } => None,
        }
    }
}

/// The name of a command.
pub struct CommandName;

impl WordArgument for CommandName {
    type Value<'a> = &'a str;
    const KIND: Kind = Kind::Command;

    fn parse(text: &str) -> Option<&str> {
        find(text).map(|_| text)
    }
}

impl<'a> Command<'a> {
    /// Parses a line: a command and its arguments, separated by blanks. The result of a blank line is `None`.
    ///
    /// # Errors
    /// The line is not a command.
    // Not inlined, because the main loop would grow by several KiB.
    #[inline(never)]
    pub fn parse(line: &'a str) -> Result<Option<Self>, ParseError<'a>> {
        let mut words = Words::new(line);
        let Some(word) = words.next() else {
            return Ok(None);
        };
        let (syntax, read) = match entry(word.text) {
            Some(Entry::Built { syntax, read }) => (syntax, read),
            Some(&Entry::LeftOut { feature, .. }) => {
                return Err(ParseError(ParseErrorKind::LeftOut { word, feature }));
            }
            None => return Err(ParseError(ParseErrorKind::Unknown { word })),
        };
        let mut reader = Reader::new(syntax, word, words);
        let command = read(&mut reader);
        reader.end()?;
        Ok(command)
    }
}

fn entry(name: &str) -> Option<&'static Entry> {
    COMMANDS.iter().find(|entry| entry.name() == name)
}

/// Returns the syntax of the command with this name; `None` for an unknown name, and for a command that this build leaves out.
pub(super) fn find(name: &str) -> Option<&'static Syntax> {
    entry(name)?.syntax()
}

/// Returns the syntax of every command of this build, in the order of the help.
pub(super) fn syntaxes() -> impl Iterator<Item = &'static Syntax> {
    COMMANDS.iter().filter_map(Entry::syntax)
}

/// Writes the help of `command`, or the list of all commands if the name is missing or unknown.
///
/// # Errors
/// The errors of the writer `out`.
pub fn write_help(out: &mut dyn fmt::Write, command: Option<&str>) -> fmt::Result {
    match command.and_then(find) {
        Some(syntax) => {
            writeln!(out, "{syntax}\n  {}", syntax.summary)?;
            syntax.visit(&mut |parameter| writeln!(out, "  {}: {parameter}", parameter.form()))
        }
        None => {
            syntaxes()
                .try_for_each(|syntax| writeln!(out, "{:13}{}", syntax.name, syntax.summary))?;
            writeln!(out, "`help COMMAND` explains one command")
        }
    }
}
