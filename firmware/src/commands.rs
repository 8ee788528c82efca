//! What each command does.
//!
//! A reply is text, then `ok` or `error: …`. What a program reads are lines of a key and its value.

use core::fmt::{self, Display};

use glint_core::camera::{View, ViewError};
use glint_core::console::{Command, ParseError, write_help};
use glint_core::fixed::{Q32_32, Turns};
use glint_core::light::MAX_LIGHTS;
use glint_core::mesh::MeshError;
use glint_core::orientation::log::LogError;
use glint_core::picture::Backend;
use glint_core::wire::{Failure, Manifest, crc32};
use glint_hal::timer::FREQUENCY;
use glint_hal::triangle::Counters;
use glint_model::raymarch::FieldStats;
use glint_model::{FrameStats, RenderError};
use heapless::Vec;
use litex_pac::{cpu, ctrl};

use crate::gateware::Fallback;
use crate::machine::{Job, Machine};
use crate::models::{FIELDS, Model};
use crate::scene::{RenderedBy, Scene, Sphere};
use crate::terminal::Terminal;
use crate::{appearance, bench, imu, replay, selftest, transfer};

/// What a command leads to.
pub enum Reply<'l> {
    /// Nothing was asked.
    Nothing,
    /// It is done, or refused.
    Now(Result<(), Refusal<'l>>),
    /// It is done when this is.
    After(Job),
}

/// Why a command was not done; its `Display` is what follows `error: `.
#[derive(Debug)]
pub enum Refusal<'l> {
    /// It is no command.
    Parse(ParseError<'l>),
    /// It was longer than any command.
    Overlong,
    /// Its camera is out of range.
    View(ViewError),
    /// There is no such line of `info`.
    Key(&'l str),
    /// There is no model and no field of this name.
    Scene(&'l str),
    /// Nothing has been uploaded.
    NoUpload,
    /// There is no such renderer here.
    NoEngine,
    /// Two eyes were asked for while a field is shown with the mesh in it.
    StereoOfMesh,
    /// The mesh in a field was asked for while two eyes look.
    MeshInStereo,
    /// There are as many lights as there may be.
    Lights,
    /// What is to be measured is not shown.
    NotShown(&'l str),
    /// The engine could not draw.
    Engine(Fallback),
    /// An upload is longer than there is room for.
    TooLong {
        /// Whose upload it is.
        command: &'static str,
        /// Its bytes.
        bytes: u32,
        /// Bytes of room.
        room: usize,
    },
    /// A transfer failed.
    Transfer(Failure),
    /// What was uploaded is not a mesh.
    Mesh(MeshError),
    /// The frame could not be drawn.
    Render(RenderError),
    /// No frame has been drawn yet.
    NoFrame,
    /// There is no kernel of this name.
    Kernel(&'l str),
    /// Some of the machine's own tests failed.
    SelfTest(u32),
    /// The sensor was not calibrated.
    Calibration(imu::Refusal),
    /// There are no samples.
    Sensor(imu::Failure),
    /// What was uploaded is not a log.
    Log(LogError),
    /// No log has been replayed to its end since the last upload.
    NoReplay,
    /// Devices are left alone on gateware of another build.
    Mismatch,
}

impl Display for Refusal<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Parse(error) => error.fmt(f),
            Self::Overlong => {
                write!(
                    f,
                    "line: expected at most {} bytes, came more",
                    glint_core::console::LINE_MAX
                )
            }
            Self::View(error) => error.fmt(f),
            Self::Key(key) => write!(f, "info `{key}`: expected a key that `info` alone lists"),
            Self::Scene(name) => {
                write!(f, "scene `{name}`: expected")?;
                let fields = FIELDS.iter().map(|(name, _)| *name);
                Model::ALL
                    .iter()
                    .map(|model| model.name())
                    .chain(fields)
                    .enumerate()
                    .try_for_each(|(index, name)| {
                        write!(f, "{} {name}", if index == 0 { "" } else { " or" })
                    })
            }
            Self::NoUpload => {
                f.write_str("scene model: nothing has been uploaded, expected a `load` before")
            }
            Self::StereoOfMesh => f.write_str(
                "stereo: two eyes see a field without a mesh, expected `mesh off` before",
            ),
            Self::MeshInStereo => f.write_str(
                "mesh: two eyes see a field without a mesh, expected `stereo off` before",
            ),
            Self::Lights => write!(
                f,
                "light: expected at most {MAX_LIGHTS}, `light default` takes them away"
            ),
            Self::NotShown(kernel) => {
                write!(
                    f,
                    "bench {kernel}: something else is shown, see `help field`"
                )
            }
            Self::NoEngine => {
                f.write_str("gateware: this SoC has no triangle engine, expected cpu")
            }
            Self::Engine(fault) => fault.fmt(f),
            Self::TooLong {
                command,
                bytes,
                room,
            } => {
                write!(f, "{command} {bytes}: expected at most {room} bytes")
            }
            Self::Transfer(failure) => failure.fmt(f),
            Self::Mesh(error) => write!(f, "load: not a mesh, the model before stays: {error}"),
            Self::Render(error) => write!(f, "render: {error}"),
            Self::NoFrame => {
                f.write_str("stats: no frame has been drawn yet, expected a `render` before")
            }
            Self::Kernel(name) => {
                write!(f, "bench `{name}`: expected one of")?;
                bench::KERNELS
                    .iter()
                    .try_for_each(|kernel| write!(f, " {kernel}"))
            }
            Self::Calibration(refusal) => write!(f, "imu calibrate: {refusal}"),
            Self::Sensor(error) => write!(f, "imu: {error}"),
            Self::Log(error) => write!(f, "replay: {error}"),
            Self::NoReplay => {
                f.write_str("replay: there are no attitudes, expected an upload of a log before")
            }
            Self::SelfTest(failed) => write!(f, "selftest: {failed} failed, expected none"),
            Self::Mismatch => f.write_str(
                "devices are not touched on gateware of another build, expected a matching one",
            ),
        }
    }
}

/// Does what `line` says.
pub fn execute<'l>(machine: &mut Machine, line: &'l str) -> Reply<'l> {
    let command = match Command::parse(line) {
        Ok(command) => command,
        Err(error) => return Reply::Now(Err(Refusal::Parse(error))),
    };
    let result = match command {
        Command::Empty => return Reply::Nothing,
        Command::Render { depth } => {
            machine.scene.touch();
            machine.scene.want_depth(depth);
            return Reply::After(Job::Render);
        }
        Command::Frame { depth } => {
            machine.scene.want_depth(depth);
            return Reply::After(Job::Frame { depth });
        }
        Command::Orbit { frames } => {
            return Reply::After(Job::Orbit(Orbit::new(machine.scene.sphere(), frames)));
        }
        Command::Help(name) => {
            // A line that takes nothing has nobody listening.
            let _ = write_help(machine.terminal.output(), name);
            Ok(())
        }
        Command::Info(key) => info(machine, key),
        Command::Scene(name) => scene(machine, name),
        Command::Field(None) => {
            let field = machine.scene.field();
            print_choice(&mut machine.terminal, "field", field);
            Ok(())
        }
        Command::Field(Some(field)) => {
            machine.scene.set_field(field);
            Ok(())
        }
        Command::Stereo(None) => {
            let stereo = machine.scene.stereo();
            print_choice(&mut machine.terminal, "stereo", stereo);
            Ok(())
        }
        Command::Stereo(Some(stereo)) => {
            if stereo.is_some() && machine.scene.with_mesh() {
                return Reply::Now(Err(Refusal::StereoOfMesh));
            }
            machine.scene.set_stereo(stereo);
            Ok(())
        }
        Command::Mesh(None) => {
            let with_mesh = switch_name(machine.scene.with_mesh());
            machine.terminal.print(format_args!("mesh {with_mesh}\n"));
            Ok(())
        }
        Command::Mesh(Some(true)) if machine.scene.stereo().is_some() => Err(Refusal::MeshInStereo),
        Command::Mesh(Some(with_mesh)) => {
            machine.scene.set_with_mesh(with_mesh);
            Ok(())
        }
        Command::Material(_)
        | Command::Light(_)
        | Command::Ambient(_)
        | Command::Background(_)
        | Command::Fog(_)
        | Command::Occlusion(_) => appearance::execute(machine, &command),
        Command::Camera { r, theta, phi } => machine
            .scene
            .set_sphere(Sphere { r, theta, phi })
            .map_err(Refusal::View),
        Command::View(None) => {
            print_view(machine);
            Ok(())
        }
        Command::View(Some(view)) => {
            machine.scene.set_view(view);
            Ok(())
        }
        Command::Look { yaw, pitch, roll } => {
            View::look(machine.scene.view().eye(), yaw, pitch, roll)
                .map(|view| machine.scene.move_view(view))
                .map_err(Refusal::View)
        }
        Command::Size(size) => {
            machine.scene.set_size(size);
            Ok(())
        }
        Command::Load(manifest) => load(machine, manifest),
        Command::Replay(None) => replay::send(machine),
        Command::Replay(Some(manifest)) => return replay::begin(machine, manifest),
        Command::Cull(cull) => {
            machine.scene.set_cull(cull);
            Ok(())
        }
        Command::Prepass(prepass) => {
            machine.scene.set_prepass(prepass);
            Ok(())
        }
        Command::Stats { json } => stats(machine, json),
        Command::Backend(None) => {
            let backend = machine.scene.backend();
            machine.terminal.print(format_args!("backend {backend}\n"));
            Ok(())
        }
        Command::Backend(Some(Backend::Gateware)) if machine.renderer.gateware.is_none() => {
            Err(Refusal::NoEngine)
        }
        Command::Backend(Some(backend)) => {
            machine.scene.set_backend(backend);
            Ok(())
        }
        Command::Shading(None) => {
            let shading = machine.scene.shading();
            machine.terminal.print(format_args!("shading {shading}\n"));
            Ok(())
        }
        Command::Shading(Some(shading)) => {
            machine.scene.set_shading(shading);
            Ok(())
        }
        Command::Imu(action) => return imu::execute(machine, action),
        Command::Mounting(None) => {
            let mounting = machine.imu.mounting();
            machine
                .terminal
                .print(format_args!("mounting {mounting}\n"));
            Ok(())
        }
        Command::Mounting(Some(mounting)) => {
            machine.imu.set_mounting(mounting);
            Ok(())
        }
        Command::Sensitivity(None) => {
            let times = Q32_32::from_num(machine.imu.sensitivity()) / 256;
            machine
                .terminal
                .print(format_args!("sensitivity {times}\n"));
            Ok(())
        }
        Command::Sensitivity(Some(times)) => {
            machine.imu.set_sensitivity(times);
            Ok(())
        }
        Command::Bench(kernel) => bench::run(machine, kernel),
        Command::SelfTest => match selftest::run(machine) {
            0 => Ok(()),
            failed => Err(Refusal::SelfTest(failed)),
        },
        Command::Leds(value) => leds(machine, value),
        Command::Buttons => buttons(machine),
        Command::Reboot => reboot(machine),
    };
    Reply::Now(result)
}

fn info<'l>(machine: &mut Machine, key: Option<&'l str>) -> Result<(), Refusal<'l>> {
    let Machine {
        terminal,
        identity,
        models,
        scene,
        renderer,
        clock,
        uart,
        ..
    } = machine;
    let staging = models.staging();
    let (address, room) = (staging.as_ptr().addr(), staging.len());
    let mesh = models.mesh();
    let (field, model) = (scene.field(), models.shown().name());
    let with_mesh = match field {
        Some(_) if scene.with_mesh() => format_args!(" with {model}"),
        _ => format_args!(""),
    };
    let shown: &dyn Display = field.map_or(&model, |field| field);
    let [width, height] = scene.size().pixels();
    let (frame, depth) = (renderer.display.front().as_ptr(), renderer.depth.as_ptr());
    let counters = renderer.display.counters();
    let lines: [(&str, fmt::Arguments); 18] = [
        ("version", format_args!("{}", env!("CARGO_PKG_VERSION"))),
        ("firmware_id", format_args!("{:#010x}", identity.firmware)),
        ("gateware_id", format_args!("{:#010x}", identity.gateware)),
        ("blocks", format_args!("{:#x}", identity.blocks)),
        ("clock", format_args!("{FREQUENCY}")),
        ("scene", format_args!("{shown}{with_mesh}")),
        ("vertices", format_args!("{}", mesh.vertex_count())),
        ("triangles", format_args!("{}", mesh.triangle_count())),
        ("size", format_args!("{width} {height}")),
        ("shading", format_args!("{}", scene.shading())),
        ("backend", format_args!("{}", scene.backend())),
        ("frame", format_args!("{:#010x}", frame.addr())),
        ("depth", format_args!("{:#010x}", depth.addr())),
        ("staging", format_args!("{address:#010x} {room}")),
        ("video_frames", format_args!("{}", counters.frame_count)),
        (
            "video_underflows",
            format_args!("{}", counters.underflow_count),
        ),
        ("uart_lost", format_args!("{}", uart.lost())),
        ("uptime_ms", format_args!("{}", clock.milliseconds())),
    ];
    let mut found = key.is_none();
    for (name, value) in lines {
        if key.is_none_or(|key| key == name) {
            terminal.print(format_args!("{name} {value}\n"));
            found = true;
        }
    }
    match key {
        Some(key) if !found => Err(Refusal::Key(key)),
        _ => Ok(()),
    }
}

fn scene<'l>(machine: &mut Machine, name: Option<&'l str>) -> Result<(), Refusal<'l>> {
    let Machine {
        terminal,
        models,
        scene,
        ..
    } = machine;
    let Some(name) = name else {
        let field = scene.field();
        for model in Model::ALL {
            let shown = (field.is_none() || scene.with_mesh()) && model == models.shown();
            let state = match (shown, models.has(model)) {
                (true, _) => "shown",
                (_, true) => "there",
                (_, false) => "empty",
            };
            terminal.print(format_args!("scene {} {state}\n", model.name()));
        }
        for (name, named) in FIELDS {
            let shown = field == Some(&named);
            let state = if shown { "shown" } else { "there" };
            terminal.print(format_args!("scene {name} {state}\n"));
        }
        return Ok(());
    };
    if let Some((_, field)) = FIELDS.iter().find(|(field, _)| *field == name) {
        scene.set_field(Some(*field));
        return Ok(());
    }
    let model = Model::ALL
        .into_iter()
        .find(|model| model.name() == name)
        .ok_or(Refusal::Scene(name))?;
    let before = models.shown();
    if !models.show(model) {
        return Err(Refusal::NoUpload);
    }
    scene.set_field(None);
    if model != before {
        scene.touch();
    }
    Ok(())
}

/// Prints what may be off.
pub fn print_choice(terminal: &mut Terminal, name: &str, chosen: Option<impl Display>) {
    match chosen {
        Some(chosen) => terminal.print(format_args!("{name} {chosen}\n")),
        None => terminal.print(format_args!("{name} off\n")),
    }
}

fn print_view(machine: &mut Machine) {
    let view = *machine.scene.view();
    let terminal = &mut machine.terminal;
    let [x, y, z] = view.eye();
    terminal.print(format_args!("view {x} {y} {z}"));
    for [x, y, z] in [view.u(), view.v(), view.n()] {
        terminal.print(format_args!(" {x} {y} {z}"));
    }
    terminal.print(format_args!(" {} {}\n", view.half_width(), view.near()));
}

fn load<'l>(machine: &mut Machine, manifest: Manifest) -> Result<(), Refusal<'l>> {
    stage(machine, "load", manifest)?;
    let length = manifest.length as usize;
    machine.models.accept(length).map_err(Refusal::Mesh)?;
    machine.scene.set_field(None);
    machine.scene.touch();
    Ok(())
}

/// Takes the upload of a command into the staging memory, over the line unless it is there already.
pub fn stage<'m>(
    machine: &'m mut Machine,
    command: &'static str,
    manifest: Manifest,
) -> Result<&'m mut [u8], Refusal<'static>> {
    let Machine {
        terminal,
        models,
        replay,
        clock,
        uart,
        ..
    } = machine;
    let staging = models.staging();
    let room = staging.len();
    let Some(staging) = staging.get_mut(..manifest.length as usize) else {
        return Err(Refusal::TooLong {
            command,
            bytes: manifest.length,
            room,
        });
    };
    // What a replay has left there is overwritten, or becomes a mesh.
    *replay = None;
    // Another master may have written there: a tool's back door, or a transfer that was cut off near its end.
    cpu::flush_data_cache();
    if crc32(staging) != manifest.crc32 {
        terminal.print(format_args!("ready\n"));
        transfer::receive(uart, *clock, staging, manifest).map_err(Refusal::Transfer)?;
    }
    Ok(staging)
}

/// Sends the frame drawn last.
pub fn send_frame(machine: &mut Machine, depth: bool) -> Result<(), Refusal<'static>> {
    let Machine {
        scene,
        renderer,
        downloads,
        ..
    } = machine;
    scene
        .drawn()
        .ok_or(Refusal::NoFrame)?
        .map_err(Refusal::Render)?;
    // The engine writes beside the cache.
    cpu::flush_data_cache();
    let bytes = if depth {
        bytemuck::cast_slice(renderer.depths(scene))
    } else {
        bytemuck::cast_slice(renderer.colours(scene))
    };
    downloads
        .send(&mut machine.terminal, bytes)
        .map_err(Refusal::Transfer)
}

/// Prints what the last frame took.
pub fn stats(machine: &mut Machine, json: bool) -> Result<(), Refusal<'static>> {
    let drawn = machine
        .scene
        .drawn()
        .ok_or(Refusal::NoFrame)?
        .map_err(Refusal::Render)?;
    let mut values: Vec<(&str, u64), 16> = Vec::new();
    let (backend, engine) = match drawn.by {
        RenderedBy::Cpu(fallback) => {
            if let Some(fallback) = fallback
                && !json
            {
                machine
                    .terminal
                    .print(format_args!("fallback {fallback}\n"));
            }
            (Backend::Cpu, None)
        }
        RenderedBy::Gateware(counters) => (Backend::Gateware, Some(counters)),
    };
    // There is room for them all.
    let _ = values.push(("cycles", drawn.cycles));
    let FrameStats { mesh, field } = drawn.stats;
    if let Some(stats) = mesh {
        let _ = values.extend_from_slice(&[
            ("triangles_in", stats.triangles_in.into()),
            ("triangles_culled", stats.culled.into()),
            ("triangles_clipped", stats.clipped.into()),
            ("triangles_drawn", stats.drawn.into()),
            ("pixels_tested", stats.pixels_tested),
            ("pixels_covered", stats.pixels_covered),
        ]);
        // An engine counts the field's with them.
        if field.is_none() {
            let _ = values.push(("pixels_drawn", stats.pixels_drawn));
        }
    }
    if let Some(stats) = field {
        let _ = values.extend_from_slice(&ray_values(&stats));
    }
    let _ = values.push(("clock", FREQUENCY.into()));
    let values = values
        .into_iter()
        .chain(engine.iter().flat_map(engine_values));
    let terminal = &mut machine.terminal;
    if !json {
        terminal.print(format_args!("backend {backend}\n"));
        for (key, value) in values {
            terminal.print(format_args!("{key} {value}\n"));
        }
        return Ok(());
    }
    terminal.print(format_args!("{{\"backend\":\"{backend}\""));
    for (key, value) in values {
        terminal.print(format_args!(",\"{key}\":{value}"));
    }
    terminal.print(format_args!("}}\n"));
    Ok(())
}

/// What was counted of a field by name.
pub fn ray_values(stats: &FieldStats) -> [(&'static str, u64); 5] {
    [
        ("rays", stats.rays.into()),
        ("evaluations", stats.evaluations),
        ("hits", stats.hits.into()),
        ("misses", stats.misses.into()),
        ("undecided", stats.undecided.into()),
    ]
}

/// The engine's counters by name.
pub fn engine_values(counters: &Counters) -> impl Iterator<Item = (&'static str, u64)> {
    counters.iter().filter_map(|(name, value)| {
        let name = match name {
            "items_in" => "words_read",
            "items_out" => "words_written",
            // Printed with the triangles, without the pixels of a field.
            "pixels_covered" | "pixels_drawn" => return None,
            name => name,
        };
        Some((name, value.into()))
    })
}

/// A switch on the console.
pub const fn switch_name(on: bool) -> &'static str {
    if on { "on" } else { "off" }
}

fn leds<'l>(machine: &mut Machine, value: u16) -> Result<(), Refusal<'l>> {
    machine
        .devices
        .as_ref()
        .ok_or(Refusal::Mismatch)?
        .leds
        .set(value);
    machine.heartbeat = false;
    Ok(())
}

fn buttons<'l>(machine: &mut Machine) -> Result<(), Refusal<'l>> {
    let devices = machine.devices.as_ref().ok_or(Refusal::Mismatch)?;
    let (buttons, switches) = (devices.buttons.read(), devices.switches.read());
    machine.terminal.print(format_args!(
        "buttons {buttons:#x}\nswitches {switches:#06x}\n"
    ));
    Ok(())
}

/// Kept whole: tests find it in the program, and put a trap in its place.
#[inline(never)]
fn reboot(machine: &mut Machine) -> ! {
    machine.terminal.print(format_args!("ok\n"));
    machine.terminal.flush();
    machine
        .ctrl
        .reset()
        .write(ctrl::Reset::default().with_soc_rst(true));
    // The reset takes a few cycles.
    loop {
        core::hint::spin_loop();
    }
}

/// A turn of the spherical camera around the model, a frame at a time.
#[derive(Clone, Copy)]
pub struct Orbit {
    start: Sphere,
    frames: u32,
    frame: u32,
}

/// Frames of a turn that says nothing else: one a degree and a half.
const ORBIT_FRAMES: u32 = 240;

impl Orbit {
    fn new(start: Sphere, frames: Option<u32>) -> Self {
        Self {
            start,
            frames: frames.unwrap_or(ORBIT_FRAMES),
            frame: 0,
        }
    }

    /// Moves the camera on; nothing when the turn is complete.
    pub fn step(self, scene: &mut Scene) -> Option<Self> {
        if self.frame == self.frames {
            return None;
        }
        let frame = self.frame + 1;
        // The product has 64 bits and the quotient is at most a whole turn, which wraps to none.
        let turned = Turns(((u64::from(frame) << 32) / u64::from(self.frames)) as u32);
        let sphere = Sphere {
            theta: self.start.theta.wrapping_add(turned),
            ..self.start
        };
        // It starts from a legal camera and changes only the azimuth, and every azimuth is legal.
        scene.set_sphere(sphere).ok()?;
        Some(Self { frame, ..self })
    }
}
