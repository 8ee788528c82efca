//! The command `bench`: measures the selected kernels and prints their cycles.

use glint_scene::SettingError;

use super::statistics::{engine_values, ray_values};
use crate::bench::{self, Cycles};
use crate::error::CommandError;
use crate::machine::Machine;

/// Names of the kernels that `bench` accepts.
#[cfg(not(feature = "peers"))]
const KERNELS: &[&str] = &["sine", "object", "triangle", "field"];
/// Names of the kernels that `bench` accepts in a build with the feature `peers`.
#[cfg(feature = "peers")]
const KERNELS: &[&str] = &[
    "sine", "object", "attitude", "geometry", "gesture", "kernels", "triangle", "field",
];

/// Default number of frames that the gateware draws back to back in one measurement.
const FRAMES: u32 = 8;

/// Measures a kernel and prints its cycles. `benchmark` is the kernel's name, with a number of frames for a kernel that draws frames.
/// Without `benchmark`, measures sine and cosine, and the drawing of frames if the SoC has a triangle engine.
///
/// # Errors
/// The name is unknown, the kernel needs a triangle engine that the SoC lacks, the kernel needs another scene, or a number of frames
/// follows a kernel that draws no frames.
pub fn run<'l>(
    machine: &mut Machine,
    benchmark: Option<(&'l str, Option<u32>)>,
) -> Result<(), CommandError<'l>> {
    let has_engine = machine.renderer.gateware.is_some();
    let mut print = |name: &str, cycles: Cycles| {
        let Cycles { min, median, max } = cycles;
        machine.terminal.print(format_args!(
            "bench {name} min {min} median {median} max {max} cycles\n"
        ));
    };
    match benchmark {
        None => {
            bench::sine(&mut print);
            if has_engine {
                frames(machine, FRAMES)?;
            }
        }
        Some(("triangle" | "field", _)) if !has_engine => return Err(SettingError::NoEngine.into()),
        Some(("triangle", _)) if machine.scene.field.is_some() => {
            return Err(CommandError::FieldShown);
        }
        Some(("field", _)) if machine.scene.field.is_none() => return Err(CommandError::NoField),
        Some(("triangle" | "field", count)) => frames(machine, count.unwrap_or(FRAMES))?,
        Some((name, Some(_))) => {
            return Err(CommandError::Kernel(name, &["triangle", "field"]));
        }
        Some(("sine", None)) => bench::sine(&mut print),
        Some(("object", None)) => bench::object(&mut print),
        #[cfg(feature = "peers")]
        Some(("attitude", None)) => bench::attitude(&mut print),
        #[cfg(feature = "peers")]
        Some(("geometry", None)) => bench::geometry(&mut print),
        #[cfg(feature = "peers")]
        Some(("gesture", None)) => bench::gesture(&mut print),
        #[cfg(feature = "peers")]
        Some(("kernels", None)) => bench::kernels(&mut print),
        Some((name, None)) => return Err(CommandError::Kernel(name, KERNELS)),
    }
    Ok(())
}

/// Measures the drawing of `count` frames of the current scene, back to back: the geometry pass of each frame runs during the raster pass
/// of the previous frame. The frames are not shown.
fn frames<'l>(machine: &mut Machine, count: u32) -> Result<(), CommandError<'l>> {
    let Machine {
        terminal,
        scene,
        models,
        renderer,
        ..
    } = machine;
    models.update(scene, &mut || {});
    // Waits until the last drawn frame is shown, because only then is a frame buffer free.
    let rendered = loop {
        if let Some(rendered) = renderer.repeat(&models.frame(scene), count) {
            break rendered.map_err(CommandError::Engine)?;
        }
    };
    let rays = rendered.stats.field;
    let kernel = match (&rays, &rendered.stats.wireframe) {
        (Some(_), _) => "field",
        (None, Some(_)) => "lines",
        (None, None) => "triangle",
    };
    terminal.print(format_args!(
        "bench {kernel} frames {count} cycles {} soft_core {}",
        rendered.cycles,
        rendered.cycles - rendered.waited
    ));
    if let Some(stats) = rays {
        for (name, value) in ray_values(&stats) {
            terminal.print(format_args!(" {name} {value}"));
        }
    }
    for (name, value) in engine_values(&rendered.counters) {
        terminal.print(format_args!(" {name} {value}"));
    }
    terminal.print(format_args!("\n"));
    Ok(())
}
