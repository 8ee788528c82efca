//! The command `stats`: statistics of the last frame, as keys and values.

use core::fmt::Display;

use glint_core::picture::Backend;
use glint_hal::frequency::Frequency;
use glint_hal::triangle::Counters;
use glint_model::FrameStats;
use glint_model::raymarch::FieldStats;
use glint_program::drawn::RenderedBy;
use heapless::Vec;

use crate::error::CommandError;
use crate::machine::Machine;

/// Prints the statistics of the last frame.
///
/// # Errors
/// No frame has been drawn, or the drawing of the last frame failed.
pub fn print(machine: &mut Machine, json: bool) -> Result<(), CommandError<'static>> {
    let Machine {
        terminal,
        picture,
        clock,
        ..
    } = machine;
    let drawn = picture
        .drawn()
        .ok_or(CommandError::NoFrame)?
        .map_err(CommandError::Render)?;
    let (backend, engine, fallback): (_, _, Option<&dyn Display>) = match &drawn.by {
        RenderedBy::Cpu(reason) => (
            Backend::Cpu,
            None,
            reason.as_ref().map(|reason| reason as _),
        ),
        RenderedBy::Gateware(counters, unsupported) => {
            let unsupported = unsupported.as_ref().map(|unsupported| unsupported as _);
            (Backend::Gateware, Some(counters), unsupported)
        }
    };
    let hint = picture.hint();
    let texts = [
        ("fallback", fallback),
        ("hint", hint.as_ref().map(|hint| hint as _)),
    ];
    let texts = texts.iter().filter_map(|(key, text)| Some((key, (*text)?)));
    if !json {
        for (key, text) in texts.clone() {
            terminal.print_entry(key, text);
        }
    }
    let soft_core = engine.map(|counters| {
        let cycles = drawn.cycles.saturating_sub(counters.cycles_busy.into());
        ("cycles_soft_core", cycles)
    });
    let values = frame_values(drawn.cycles, &drawn.stats, clock.frequency())
        .into_iter()
        .chain(soft_core)
        .chain(engine.into_iter().flat_map(engine_values));
    if !json {
        terminal.print_entry("backend", &backend);
        for (key, value) in values {
            terminal.print_entry(key, &value);
        }
        return Ok(());
    }
    terminal.print(format_args!("{{\"backend\":\"{backend}\""));
    for (key, value) in values {
        terminal.print(format_args!(",\"{key}\":{value}"));
    }
    for (key, text) in texts {
        // The texts have neither quotation marks nor control characters.
        terminal.print(format_args!(",\"{key}\":\"{text}\""));
    }
    terminal.print(format_args!("}}\n"));
    Ok(())
}

/// Statistics of a frame that both backends (CPU and gateware) report, as names and values. The list has room for all statistics.
fn frame_values(
    cycles: u64,
    stats: &FrameStats,
    frequency: Frequency,
) -> Vec<(&'static str, u64), 16> {
    let mut values = Vec::new();
    let _ = values.push(("cycles", cycles));
    if let Some(mesh) = &stats.mesh {
        let _ = values.extend_from_slice(&[
            ("triangles_in", mesh.triangles_in.into()),
            ("triangles_culled", mesh.culled.into()),
            ("triangles_clipped", mesh.clipped.into()),
            ("triangles_drawn", mesh.drawn.into()),
        ]);
        values.extend(mesh.pixels_tested.map(|tested| ("pixels_tested", tested)));
        let _ = values.push(("pixels_covered", mesh.pixels_covered));
        // The triangle engine's count of drawn pixels includes the pixels of a field, so it is printed only without a field.
        if stats.field.is_none() {
            let _ = values.push(("pixels_drawn", mesh.pixels_drawn));
        }
    }
    if let Some(field) = &stats.field {
        let _ = values.extend_from_slice(&ray_values(field));
    }
    if let Some(wireframe) = &stats.wireframe {
        let _ = values.extend_from_slice(&[
            ("segments", wireframe.segments.into()),
            ("lines", wireframe.lines.into()),
            ("line_pixels", wireframe.pixels),
        ]);
    }
    if let Some(edges) = &stats.edges {
        let _ = values.extend_from_slice(&[
            ("edges_in", edges.edges.into()),
            ("edges_drawn", edges.drawn.into()),
        ]);
    }
    let _ = values.push(("clock", frequency.hertz().into()));
    values
}

/// Counts of a field's rays, as names and values.
pub fn ray_values(stats: &FieldStats) -> [(&'static str, u64); 5] {
    [
        ("rays", stats.rays.into()),
        ("evaluations", stats.evaluations),
        ("hits", stats.hits.into()),
        ("misses", stats.misses.into()),
        ("undecided", stats.undecided.into()),
    ]
}

/// Counters of the triangle engine, as names and values.
pub fn engine_values(counters: &Counters) -> impl Iterator<Item = (&'static str, u64)> {
    counters.iter().filter_map(|(name, value)| {
        let name = match name {
            "items_in" => "words_read",
            "items_out" => "words_written",
            // These two counters are omitted, because `frame_values` prints the counts without the pixels of a field.
            "pixels_covered" | "pixels_drawn" => return None,
            name => name,
        };
        Some((name, value.into()))
    })
}
