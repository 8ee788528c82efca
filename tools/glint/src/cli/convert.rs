//! `glint model` and `glint convert`.

use super::common::bad_value;
use super::messages::{print_json, say, warn};
use super::output::{MESH, Output, STDOUT};
use super::progress::spinner;
use super::texture::{MeshTextureArguments, print_textures};
use clap::{Args, ValueEnum};
use glint::convert::{self, Options, Report};
use glint::error::FormatError;
use glint::formats::{Format, write};
use glint::polygons::Polygons;
use glint::{generate, model};
use serde::Serialize;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Generate a model: cube, icosphere:N, torus-knot, gear, teapot, globe, hall, fence, window, scan:N or sponge:N.
#[derive(Args)]
pub struct ModelArguments {
    /// Name of the generator.
    name: String,
    /// Output file; the extension selects the format: .obj, .stl, .ply or .glm. `-` is standard output, in the format of --to.
    out: PathBuf,
    /// Format of the output [default: from the extension of its name].
    #[arg(long, value_enum)]
    to: Option<To>,
    /// Keep the generator's coordinates, without scaling.
    #[arg(long)]
    keep_scale: bool,
    /// Print the report as JSON.
    #[arg(long)]
    json: bool,
}

/// Convert a mesh: scale it to the 1×1×1 box about the origin, triangulate it, round its
/// coordinates to multiples of 2^-14, and order its triangles for the engine's vertex cache.
///
/// Reads OBJ (with vertex colours, and colours and textures from the material file in the same
/// folder), STL and PLY, ASCII or binary, glTF (with base colour textures, without skins), and GLM,
/// the format that boards load. OBJ, STL and PLY are written with scaled, unrounded coordinates and
/// without textures. Textures are PNG or JPEG files in the folder of the mesh or its subfolders, or
/// data within a glTF.
#[derive(Args)]
pub struct ConvertArguments {
    /// Mesh file to read; `-` is standard input, whose format is detected from its contents.
    input: PathBuf,
    /// Output file; the extension selects the format: .obj, .stl, .ply or .glm. `-` is standard output, in the format of --to.
    out: PathBuf,
    /// Format of the output [default: from the extension of its name].
    #[arg(long, value_enum)]
    to: Option<To>,
    /// Keep the coordinates; coordinates outside [-2, 2) are an error.
    #[arg(long)]
    keep_scale: bool,
    /// Keep the order of the triangles, instead of an order in which the engine fetches fewer vertices (.glm only).
    #[arg(long)]
    keep_order: bool,
    /// Reverse faces so that neighbouring faces have consistent winding and closed parts face
    /// outwards. A note reports parts where this is not possible.
    #[arg(long)]
    fix_winding: bool,
    #[command(flatten)]
    textures: MeshTextureArguments,
    /// Print the report as JSON.
    #[arg(long)]
    json: bool,
}

/// Output format of a mesh.
#[derive(Clone, Copy, ValueEnum)]
enum To {
    /// Wavefront OBJ.
    Obj,
    /// STL, binary.
    Stl,
    /// PLY, binary.
    Ply,
    /// The format that boards load.
    Glm,
}

impl To {
    const fn format(self) -> Format {
        match self {
            Self::Obj => Format::Obj,
            Self::Stl => Format::Stl,
            Self::Ply => Format::Ply,
            Self::Glm => Format::Glm,
        }
    }

    const fn extension(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Stl => "stl",
            Self::Ply => "ply",
            Self::Glm => "glm",
        }
    }
}

impl ModelArguments {
    pub fn run(self) -> anyhow::Result<()> {
        let polygons = generate::named(&self.name).map_err(|error| error.in_file(&self.name))?;
        let options = Options {
            keep_scale: self.keep_scale,
            ..Options::default()
        };
        convert_to(
            polygons,
            Path::new(&self.name),
            (&self.out, self.to),
            options,
            self.json,
        )
    }
}

impl ConvertArguments {
    pub fn run(self) -> anyhow::Result<()> {
        let spinner = spinner("reading");
        let polygons = model::of_mesh_file(&self.input)?;
        spinner.finish();
        let options = Options {
            keep_scale: self.keep_scale,
            keep_order: self.keep_order,
            fix_winding: self.fix_winding,
            textures: self.textures.options(),
        };
        convert_to(
            polygons,
            &self.input,
            (&self.out, self.to),
            options,
            self.json,
        )
    }
}

/// Report of a conversion to OBJ, STL or PLY.
#[derive(Serialize)]
struct Copied {
    points: usize,
    faces: usize,
    triangles: usize,
    bytes: usize,
    remarks: Vec<String>,
}

/// An output that counts the written bytes.
struct Counted<'o> {
    out: &'o mut dyn Write,
    bytes: &'o mut usize,
}

impl Write for Counted<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        *self.bytes += written;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

fn convert_to(
    mut polygons: Polygons,
    name: &Path,
    (path, to): (&Path, Option<To>),
    options: Options,
    json: bool,
) -> anyhow::Result<()> {
    let in_input = |error: FormatError| error.in_path(name);
    let (out, format) = match to {
        Some(to) => (Output::open(path, &[to.extension()], [name])?, to.format()),
        None if path == Path::new(STDOUT) => {
            return Err(bad_value("-", "--to with a format", "none").into());
        }
        None => (Output::open(path, MESH, [name])?, Format::of(path)?),
    };
    if format == Format::Glm {
        let spinner = spinner("converting");
        let (mesh, report) = convert::convert(&polygons, options).map_err(in_input)?;
        out.write(|out| out.write_all(&mesh))?;
        spinner.finish();
        return if json {
            print_json(&report)
        } else {
            print_report(&report)
        };
    }
    convert::place(&mut polygons, options).map_err(in_input)?;
    if !polygons.textures.is_empty() {
        polygons.remark("textures are left out: only .glm files have them");
    }
    let mut bytes = 0;
    out.write(|out| {
        let mut out = Counted {
            out,
            bytes: &mut bytes,
        };
        match format {
            Format::Obj => write::obj(&polygons, &mut out),
            Format::Stl => write::stl(&polygons, &mut out),
            Format::Ply | Format::Gltf | Format::Glm => write::ply(&polygons, &mut out),
        }
    })?;
    let copied = Copied {
        points: polygons.points.len(),
        faces: polygons.faces.len(),
        triangles: polygons.triangle_count(),
        bytes,
        remarks: polygons.remarks,
    };
    if json {
        return print_json(&copied);
    }
    say(format_args!(
        "{} points, {} faces, {} bytes",
        copied.points, copied.faces, copied.bytes
    ))?;
    copied
        .remarks
        .iter()
        .try_for_each(|remark| say(format_args!("note: {remark}")))
}

/// Prints the report of a conversion to GLM as text.
pub fn print_report(report: &Report) -> anyhow::Result<()> {
    let Report {
        points,
        faces,
        vertices,
        triangles,
        degenerate,
        chunks,
        fetches_before,
        fetches,
        bytes,
        scale,
        centre,
        ..
    } = report;
    let plural = if *chunks == 1 { "" } else { "s" };
    say(format_args!("read       {points} points, {faces} faces"))?;
    say(format_args!(
        "written    {vertices} vertices, {triangles} triangles, {chunks} chunk{plural}, {bytes} bytes"
    ))?;
    say(format_args!(
        "dropped    {degenerate} triangles of area 0 after rounding to 2^-14"
    ))?;
    let a_vertex = |fetches: u32| f64::from(fetches) / f64::from(*vertices);
    say(format_args!(
        "fetches    {:.2} per vertex by the engine, {:.2} in the order of the file",
        a_vertex(*fetches),
        a_vertex(*fetches_before)
    ))?;
    say(format_args!("scaled     by {scale} about {centre:?}"))?;
    say(format_args!(
        "rounding   {:.3e} at most, {:.3e} RMS ({:.3} and {:.3} units of 2^-14)",
        report.error_max, report.error_rms, report.error_max_lsb, report.error_rms_lsb
    ))?;
    print_textures(&report.textures)?;
    report
        .remarks
        .iter()
        .try_for_each(|remark| say(format_args!("note       {remark}")))
}

/// Loads the MODEL argument of a command: a mesh file, or the name of a generator. Remarks on the file become warnings.
pub fn load(name: &str, options: Options) -> anyhow::Result<model::Model> {
    let spinner = spinner("reading the model");
    let model = model::load(name, options)?;
    spinner.finish();
    for remark in model.remarks() {
        warn(format_args!("{}: {remark}", name.escape_debug()));
    }
    Ok(model)
}
