//! The table of all commands, and the parser of lines.

use core::fmt;

use super::animate::Animate;
use super::argument::{Argument, Default, Flag, Off, Or, Own, Reader, WordArgument};
use super::error::{ParseError, ParseErrorKind};
use super::forms::{FIELD, LIT, MESHES, Order, Row, key, option, switch};
use super::object::Object;
use super::program::Program;
use super::projection::Projection;
use super::syntax::{Parameter, Shape, Syntax, WordKind};
use super::table::{commands, part, shows};
use super::values::{
    Benchmark, DemoAction, FieldsOfView, Fit, GestureAction, HalfTurn, Imu, LookAt, Mounting, Name,
    SceneName, Sensitivity, Size, TextureName, Upload, UploadName, View, Whole,
};
use crate::colour::{Shading, Winding};
use crate::feature::Feature;
use crate::field::Field;
use crate::fixed::{Q32_32, Turns, U4_28, U8_28};
use crate::light::{self, Background, Highlight, Light, Material, Rgb};
use crate::picture::{Backend, Edges, Samples};
use crate::quality::Quality;
use crate::stereo::{self, Stereo};
use crate::wireframe::Key;
use crate::words::Words;

/// A machine that executes commands. Each trait from the table below extends this trait, with one method per command.
pub trait Executor<'a> {
    /// The result of a command. The result may borrow from the line.
    type Output;

    /// The result of a setting.
    fn set(&mut self, setting: Setting<'a>) -> Self::Output;

    /// The result of a command that shows an option.
    fn show(&mut self, option: OptionName) -> Self::Output;

    /// The result of a command that this build leaves out. [`Command::parse`] returns an error for such a command.
    fn left_out(&mut self, feature: Feature) -> Self::Output;
}

commands! {
    /// Commands of the machine and its devices.
    MachineCommands {
        help Help(command: Option<CommandName>): "list the commands, or explain one";
        info Info(key: Option<Name>): "show the state of the machine, or one entry of it";
        selftest SelfTest(): "test clock, memory, sensors, scan-out, and a picture of every engine against its stored checksum";
        echo Echo(word: Name): "print a word, which tells a host program where earlier output ends";
        leds Leds(value: u16): "set the 16 LEDs";
        buttons Buttons(): "show buttons and switches";
        reboot Reboot(): "reset the SoC";
    }
    options {}

    /// Commands of scenes, meshes and wireframe programs.
    SceneCommands {
        scene Scene(name: Option<SceneName>): "list meshes and scenes, or show one; a scene sets everything that the picture depends on"
            => key(Order::Subject, "teapot").named("model").without(&["object", "program"]);
        load Load(upload: Upload, name: Option<UploadName>) in UPLOAD: "upload a mesh or a texture (binary) under a name (default model) and show it";
        models Models() in UPLOAD: "list the meshes, the textures, the programs and the memory for uploads";
        unload Unload(name: UploadName) in UPLOAD: "remove an uploaded mesh, texture or program";
        program Program(action: Option<Program>) in WIREFRAME: "show or upload (binary) a wireframe program; without arguments, show the last anew, as buttons 2 and 3 do"
            => key(Order::Subject, "cube");
        press Press(key: Key, rotate: Flag) in WIREFRAME: "press a key of the wireframe for one frame: arrow keys pan, or rotate; zoom keys move along z";
    }
    options {
        field Field(field: Or<Off, Field>) or show in FIELD: "show or set the distance field; off shows the mesh"
            => key(Order::Subject, "menger:3").without(&["program"]);
        mesh Mesh(on: bool) or show in MESH_IN_FIELD: "turn the mesh in a field on or off, or show the setting";
        stereo Stereo(eyes: Or<Off, Stereo>) or show in STEREO: "show or set stereo: an eye E to each side of the camera, zero parallax at distance ZERO; off is one eye"
            => key(Order::Option, "0.05,3").with(LIT).without(&["orthographic"])
                .host(option("stereo", stereo::FORM, "Stereo: one eye E to the left of the camera and one E to the right (0 to 1), with zero parallax at the distance ZERO; lengths in world units. The left eye is red, the right eye blue or cyan [default tint: red-blue]")
                    .expects("two eyes"));
    }

    /// Commands of the demo.
    DemoCommands {
        demo Demo(action: Option<DemoAction>) in DEMO: "show the scenes of the flash's first list, or of the built-in list demo, in turn";
    }
    options {
        object Object(action: Object) or show in OBJECT: "list or show the objects; add, transform, colour or remove an object"
            => key(Order::Subject, "torus scale 0.5 move 1,0,0").action("add").list().without(&["field", "program"]);
        material Material(material: Material) or show in FIELD: "show or set the material of a field; normal colours by direction, mixed gives each sphere its own colour"
            => key(Order::Option, "jade").with(LIT)
                .host(option("material", "MATERIAL", "Material of a field; `normal` colours by the normal, `mixed` gives successive spheres different colours [default: normal]. Without a field, the colour of the material replaces the colours of meshes"));
        light Light(light: Or<Default, Light>) or show in LIGHT: "show the lights, add a light by its direction or at the camera, or restore the default lights"
            => key(Order::Option, "1,-2,3,fff0d8").list().with(LIT)
                .host(option("light", light::FORM, "A light: the direction to it, or `camera` for a light at the camera, and its colour [default colour: white]. Up to four on a field [default: none on `normal`, sun and sky on other materials], one on meshes [default: camera]; if there are several, the first light also lights the mesh in a field")
                    .expects("a light"));
        ambient Ambient(colour: Or<Default, Rgb>) or show in LIGHT: "show or set the ambient light"
            => key(Order::Option, "404040").with(LIT)
                .host(option("ambient", "RRGGBB", "Ambient light [default: 404040 with a --light; otherwise white on a field and black on meshes]")
                    .expects("a colour RRGGBB"));
        highlight Highlight(highlight: Or<Off, Highlight>) or show in LIGHT: "show or set the highlight of the first light on a field: STRENGTH * cos^EXPONENT"
            => key(Order::Option, "0.6,32").with(FIELD)
                .host(option("highlight", "STRENGTH,EXPONENT", "Highlight of the first light on a field: its strength, from 0 to 1, and its exponent, a whole number from 4 to 128. `normal` without a --light has none")
                    .expects("a highlight STRENGTH,EXPONENT such as 0.6,32"));
        shadow Shadow(on: bool) or show in LIGHT: "turn the shadows of the first light in a field on or off, or show the setting"
            => key(Order::Option, "on").with(FIELD)
                .host(switch("shadow", "on", "Shadows of the first light in a field: sponges, `boxes` and `cubes` cast shadows on their own faces. `normal` without a --light has none"));
        background Background(background: Or<Default, Background>) or show in VIEW: "show or set the background; default is white for a field and gradient for meshes, if the gateware has it"
            => key(Order::Option, "sky").with(LIT)
                .host(option("background", "white|sky|gradient|RRGGBB", "Background: `white`, `sky`, `gradient` or a colour RRGGBB [default: white behind a field, gradient behind meshes]")
                    .expects("white, sky, gradient or a colour RRGGBB"));
        fog Fog(density: Or<Off, U4_28>) or show in FOG: "show or set the fog: transmittance is exp(-distance * DENSITY)"
            => key(Order::Option, "0.1").with(LIT)
                .host(option("fog", "DENSITY", "Fog in the background's colour: transmittance is exp(-distance * DENSITY), with the distance in world units. DENSITY is from 0 to below 16")
                    .expects("a density of at least 0 and below 16"));
        occlusion Occlusion(on: bool) or show in FIELD: "turn ambient occlusion of a field on or off, or show the setting"
            => key(Order::Option, "on").with(FIELD)
                .host(switch("occlusion", "on", "Ambient occlusion: darken a field's surface where other surfaces are close"));
        undecided Undecided(on: bool) or show in FIELD: "turn the magenta colour of a field's rays at the step limit on or off, or show the setting"
            => key(Order::Option, "on").with(FIELD)
                .host(switch("undecided", "on", "Draw rays of a field that reach the step limit in magenta instead of the horizon's colour"));
        camera Camera(r: Q32_32, theta: Turns, phi: HalfTurn) in VIEW: "face the origin from distance R (2 to 5), azimuth THETA, angle PHI from the z axis"
            => key(Order::Camera, "4 30 70").with(LIT).without(&["lookat"])
                .host(option("camera", "R,THETA,PHI", "A camera on a sphere about the origin: the distance (2 to 5), azimuth and polar angle in degrees. The half width of the image plane at distance 1 is 0.9, and the near plane is at 0.1 [default: a camera that shows the whole model; with a field 4,30,60]")
                    .expects("a camera R,THETA,PHI such as 3,30,60"));
        view View(view: View) or show in VIEW: "show or set the camera: eye, basis (right, down, forward), half width, near plane, projection, window"
            => key(Order::Camera, "0 -3 0 1 0 0 0 0 -1 0 1 0 0.9 0.1").with(LIT).without(&["camera", "lookat"]);
        look Look(yaw: Turns, pitch: Turns, roll: Turns) in VIEW: "turn the camera in place: YAW to the right, PITCH down, ROLL about the view direction";
        lookat LookAt(view: LookAt) in VIEW: "look from an eye in the direction of a gaze, with z or another direction up on the screen"
            => key(Order::Camera, "3 0 1 -3 0 -1").with(LIT)
                .host(option("look-at", "EX,EY,EZ,GX,GY,GZ[,UX,UY,UZ]", "A camera at the eye E in the direction of the gaze G, with the direction U (by default z) up on the screen")
                    .expects("a camera EX,EY,EZ,GX,GY,GZ[,UX,UY,UZ] such as 3,0,1,-3,0,-1"));
        projection Projection(volume: Projection) in VIEW: "set the projection by the sides of the picture, near and far plane, or by a 4x4 matrix"
            => key(Order::Lens, "perspective -0.1 0.1 -0.05 0.06 0.1 10").with(LIT).without(&["fov", "orthographic"])
                .host(option("projection", "perspective|orthographic|matrix,…", "The projection by the sides of the picture in the near plane and the distances of near and far plane: `perspective,LEFT,RIGHT,BOTTOM,TOP,NEAR[,FAR]`, `orthographic,…`, or `matrix,` and the 16 numbers of a projection matrix of OpenGL, row by row. FAR has the effect of --far")
                    .expects("perspective or orthographic,LEFT,RIGHT,BOTTOM,TOP,NEAR[,FAR], or matrix and 16 numbers"));
        fov FieldOfView(angles: FieldsOfView) in VIEW: "set perspective by its horizontal (X) and vertical (Y) field of view in degrees; without Y, square pixels"
            => key(Order::Lens, "66").with(LIT).without(&["orthographic"])
                .host(option("fov", "DEGREES[,DEGREES]", "The horizontal field of view, 1 to 179 degrees, which replaces the camera's half width, and the vertical field of view [default: that of square pixels]")
                    .expects("1 to 179 degrees"));
        orthographic Orthographic(width: U8_28) in VIEW: "set an orthographic projection by the picture's WIDTH in world units (0.0174 to 230); fov sets perspective"
            => key(Order::Lens, "2").with(MESHES).without(FIELD)
                .host(option("orthographic", "WIDTH", "Orthographic projection, with WIDTH world units (0.0174 to 230) across the picture. A field requires perspective")
                    .expects("a width in world units"));
        near Near(distance: U4_28) in VIEW: "set the distance of the near plane from the eye in world units (0.01 to 2)"
            => key(Order::Lens, "0.5").with(LIT).without(&["projection"])
                .host(option("near", "DISTANCE", "Distance of the near plane from the eye, 0.01 to 2 world units: nothing nearer is drawn [default: the camera's, 0.1]")
                    .expects("a distance of 0.01 to 2"));
        zoom Zoom(factor: U8_28) in VIEW: "enlarge the picture about its middle by FACTOR; below 1 shows more"
            => key(Order::Lens, "1.5").with(LIT).without(&["orthographic"])
                .host(option("zoom", "FACTOR", "Enlarge the middle of the picture by this factor, with a narrower field of view")
                    .expects("a factor that leaves a field of view of 1 to 179 degrees"));
        fit Fit(lens: Option<Fit>) in FIT: "show the whole mesh, or all objects, with an axis up on the screen (default z) and a field of view"
            => key(Order::Fit, "y").named("up").with(MESHES).without(&["field", "camera", "lookat", "view"]);
    }

    /// Commands for motion.
    OrbitCommands {
        orbit Orbit(frames: Option<Whole<3_600>>) in VIEW: "turn the camera once about the z axis, in FRAMES frames (default 240)";
    }
    options {
        animate Animate(animation: Animate) or show in ANIMATE: "show or set the motion: azimuth of the camera, orbit of a sphere, turn of objects"
            => key(Order::Option, "azimuth 30").with(LIT);
    }

    /// Commands of the motion sensor (IMU).
    ImuCommands {
        imu Imu(action: Option<Imu>) in IMU: "show sensor status; calibrate, stream, or steer the camera";
        mounting Mounting(mounting: Option<Mounting>) in IMU: "show or set the sensor axes that point into the scene and up on the screen";
        sensitivity Sensitivity(gain: Option<Sensitivity>) in IMU: "show or set camera gain (0.125 to 8)";
        replay Replay(upload: Option<Upload>) in REPLAY: "upload a log (binary) and compute its attitudes, or download the last attitudes (binary)";
    }
    options {}

    /// Commands for steering by a hand in front of the image sensor.
    GestureCommands {
        gesture Gesture(action: Option<GestureAction>) in GESTURE: "show the state of the hand; let the hand steer the camera, calibrate its colour, or send its mask (binary)";
    }
    options {
        quality Quality(quality: Quality) or show: "show or set the quality: size and samples of the picture, and the precision of a field's rays"
            => key(Order::Size, "balanced");
        size Size(size: Size): "set the picture size: 320 180, 640 360 or 1280 720"
            => key(Order::Size, "640 360");
        aa Antialiasing(samples: Or<Default, Samples>) or show: "show or set the samples of a pixel: 1, or 4 for antialiasing; default is 4 where the board is fast enough"
            => key(Order::Size, "4");
        backend Backend(backend: Backend) or show: "show or set the backend that draws frames"
            => key(Order::Size, "gateware");
        shading Shading(shading: Shading) or show in MESH: "show or set the shading: flat (one colour per triangle) or smooth (interpolated)"
            => key(Order::Option, "smooth").with(MESHES)
                .host(option("shading", "SHADING", "Source of a mesh's colours: `flat` (triangles), or `smooth` (vertices, interpolated) [default: flat; smooth if the host draws a file that has a normal for each corner]"));
        cull Cull(on: bool) in MESH: "turn culling of back faces on or off"
            => key(Order::Option, "off").with(MESHES)
                .host(switch("no-cull", "off", "Do not cull back faces"));
        clip Clip(far: Or<Off, U8_28>) in MESH: "clip triangles to the picture and a far plane at distance FAR; off clips to the guard band"
            => key(Order::Option, "10").with(MESHES)
                .host(option("far", "DISTANCE", "Clip triangles to the picture, the near plane and a far plane at this distance, instead of to the near plane and the engine's guard band")
                    .expects("a distance from 0 to below 256"));
        winding Winding(rule: Winding) in MESH: "set the rule for the visible side of a triangle: mesh (order of its vertices) or screen (all are visible)"
            => key(Order::Option, "screen").with(MESHES)
                .host(option("winding", "WINDING", "The rule for the visible side of a triangle: `mesh` (the order of its vertices), or `screen` (clockwise on the screen from the upper left vertex: all triangles are visible, and none is culled) [default: mesh]"));
        textures Textures(on: bool) in TEXTURE: "turn textures of meshes on or off"
            => key(Order::Option, "off").with(MESHES)
                .host(switch("no-textures", "off", "Draw meshes without their textures"));
        texture Texture(texture: Or<Own, TextureName>) or show in TEXTURE: "show or set an uploaded texture that replaces the textures of meshes; own restores the textures of meshes"
            => key(Order::Option, "wood.png").with(MESHES);
        edges Edges(edges: Or<Off, Edges>) or show in EDGES: "show or set the edges of a mesh: hidden (only edges that no face hides) or over (on the shaded faces)"
            => key(Order::Option, "over").with(&["model"]).without(FIELD)
                .host(option("wireframe", "WIREFRAME", "Draw the edges of the model in white: `hidden` (only the edges that no face hides), or `over` (over the shaded faces)"));
        dither Dither(on: bool) or show in VIEW: "turn ordered dithering of colours on or off, or show the setting; off rounds to nearest"
            => key(Order::Option, "off").with(LIT)
                .host(switch("no-dither", "off", "Round colours to the nearest of RGB565 instead of dithering them"));
        overlay Overlay(on: bool) or show in OVERLAY: "turn the text over the picture on or off, or show the setting";
        prepass Prepass(on: bool) in FIELD: "no effect: rays need no prepass any more, and the next release rejects the command"
            => key(Order::Option, "on").with(FIELD)
                .host(switch("prepass", "on", "No effect: rays need no prepass any more, and the next release rejects the option"));
    }

    /// Commands for drawing frames.
    FrameCommands {
        render Render(depth: Flag): "draw the frame again and show its statistics; depth also writes depth codes";
        frame Frame(depth: Flag): "download the last frame (binary): colour or depth codes";
        stats Stats(json: Flag): "show statistics of the last frame";
        bench Bench(benchmark: Option<Benchmark>) in BENCH: "measure clock cycles of sine and frames, or of a kernel; triangle and field draw FRAMES frames (default 8)";
    }
    options {}
}

/// A function that reads the arguments of a command. `None` means an error, which the reader stores.
type Read = for<'a> fn(&mut Reader<'a>) -> Option<Command<'a>>;

/// An entry of the table.
enum Entry {
    /// A command of this build: its syntax, and the function that reads its arguments.
    Built { syntax: Syntax, read: Read },
    /// A command that this build leaves out, with the feature that contains it.
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
    const KIND: WordKind = WordKind::Command;

    fn parse(text: &str) -> Option<&str> {
        find(text).map(|_| text)
    }
}

impl Setting<'_> {
    /// A note for the user on a setting that this release accepts without effect, and that the next
    /// release rejects. The console and `glint` print the note.
    /// `None` for a setting with an effect.
    pub const fn note(&self) -> Option<&'static str> {
        match self {
            Self::Prepass { .. } => Some(
                "prepass has no effect: rays need no prepass any more, and the next release rejects it",
            ),
            _ => None,
        }
    }
}

impl<'a> From<Setting<'a>> for Command<'a> {
    fn from(setting: Setting<'a>) -> Self {
        Self::Set(setting)
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

/// The words that the command accepts as its first argument, without a keyword that may replace the value; `None` for an argument
/// that is not one of a list of words.
pub fn accepted_words(command: &str) -> Option<&'static [&'static str]> {
    match &find(command)?.parameters.first()?.shape {
        Shape::Word(WordKind::Words(words) | WordKind::Either(_, WordKind::Words(words))) => {
            Some(words)
        }
        Shape::Word(
            WordKind::Either(..)
            | WordKind::Text(_)
            | WordKind::Command
            | WordKind::Name(..)
            | WordKind::Forms(_),
        )
        | Shape::Flag
        | Shape::Group(_) => None,
    }
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
