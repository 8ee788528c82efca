"""Figures of the pages, computed from the tables."""

import tomllib

import numpy as np
import pandas as pd

from tables import ROOT, fixed, rows, sci, shown

CLOCK = 81.25e6


def stiff(errors):
    """The catalogue of stiff cases with expected and measured outcomes, cases of the virtual board last."""
    files = sorted((ROOT / "tools/reference/stiff").glob("*.toml"))
    subjects = [tomllib.loads(file.read_text()) for file in files]
    measured = dict(errors.set_index("case").error)
    for case in (case for subject in subjects for case in subject["case"]):
        case["measured"] = measured.get(case["name"], "the same")
        if "at_most" in case:
            unit = case["measured"].partition(" ")[2]
            case["expected"] = f"at most {shown(float(case['at_most']))} {unit}".strip()
        else:
            case["expected"] = case.get("exact") or f"refused: {case['refused']}"
    return sorted(subjects, key=lambda subject: subject.get("on_virtual_board", False))


def worst_runs(runs):
    """The largest error of each method of computing positions in a texture, over all scenes."""
    forms = runs.groupby("form", sort=False)
    return forms.agg(max_err=("max_err", "max"), divisions=("divisions", "first"), shipped=("shipped", "first")).reset_index().assign(
        family=lambda forms: np.where(forms.form.str.endswith("linear"), "linear", forms.form.where(forms.shipped, "a parabola")))


def timeline(frames, lanes):
    """Bottleneck of each frame, the cycles of the bottleneck, and the frame rates without it.

    The bottleneck is the longest part. If this part is a pass, evaluations or memory that take more than half of it are the bottleneck."""
    passes = frames.geometry + frames.raster
    evaluating = frames.evaluations.fillna(0) / lanes
    is_raster = frames.raster >= frames.geometry
    cases = [
        ("soft core", frames.soft_core >= frames[["geometry", "raster"]].max(axis=1), frames.soft_core),
        ("evaluations", is_raster & (2 * evaluating > frames.raster), evaluating),
        ("memory", 2 * frames.refused > passes, frames.refused),
        ("raster", is_raster, frames.raster),
        ("geometry", True, frames.geometry),
    ]
    names, conditions, cycles = zip(*cases)
    conditions = [np.broadcast_to(condition, len(frames)) for condition in conditions]
    limiting = np.select(conditions, cycles)
    percent = 100 / frames.cycles
    start = frames.soft_core + frames.geometry
    parts = zip(frames.soft_core * percent, frames.geometry * percent, frames.raster * percent, frames.refused * percent,
                evaluating * percent, start * percent)
    tracks = [
        [
            [("soft core", 0, core), ("geometry passes", core, geometry), ("raster passes", raster_from, raster)],
            [("refused by memory", core, refused)],
            [("evaluations", raster_from, evaluations)],
        ]
        for core, geometry, raster, refused, evaluations, raster_from in parts
    ]
    return frames.assign(
        bottleneck=np.select(conditions, names, ""),
        limiting=limiting,
        evaluating=evaluating,
        rate=CLOCK / frames.cycles,
        rate_halved=CLOCK / (frames.cycles - limiting / 2),
        rate_without=CLOCK / (frames.cycles - limiting),
        rate_overlapped=CLOCK / np.maximum(frames.soft_core, passes),
        label=[f"{frame.scene}\n{frame.cycles:,} cycles" for frame in frames.itertuples()],
        tracks=tracks,
    )


def qualities(errors, cycles):
    """Errors, cycles and rates of the frames of all qualities."""
    frames = errors.merge(cycles.drop(columns="commit"), "left")
    return frames.assign(rate=CLOCK / frames.cycles, shipped=True)


def root_mean_square(values):
    """The root mean square of numbers."""
    return np.sqrt((values ** 2).mean())


def antialiasing(errors):
    """Errors of each scene, and their RMS in the last row, in columns such as `colour_4` and, without dithering, `colour_4_off`."""
    way = errors.samples.astype(str) + np.where(errors.dithered, "", "_off")
    found = errors.assign(way=way).pivot(index="scene", columns="way", values=["colour", "edges"])
    found.columns = ["_".join(column) for column in found.columns]
    found.loc["all"] = root_mean_square(found)
    return found.join(errors.groupby("scene").share.first()).reset_index()


def before(errors):
    """RMS of the errors of all scenes: before antialiasing and dithering were added, and with both."""
    return root_mean_square(errors[["before", "dithered", "nearest"]])


def samples(errors, cycles):
    """Errors of dithered frames with one and four samples a pixel, with their cycles and rates."""
    frames = errors.query("dithered").merge(cycles.drop(columns="commit"), on=["scene", "samples"])
    return frames.assign(rate=CLOCK / frames.alone, family=frames.scene, shipped=False, label=frames.samples)


def ratios(cycles):
    """The smallest and the largest ratio of the cycles of a frame with four samples a pixel to the cycles of the frame with one sample."""
    alone = cycles.pivot(index="scene", columns="samples", values="alone")
    found = alone[4] / alone[1]
    return found.min(), found.max()


def patterns(errors):
    """The errors of each pattern of samples: RMS of the scenes. The pattern `centre` counts as the grid of one sample."""

    def of(column, chosen):
        return chosen.groupby(["pattern", "samples"], sort=False)[column].agg(root_mean_square)

    found = errors.groupby(["pattern", "samples"], sort=False).shipped.first().to_frame()
    found = found.assign(colour=of("colour", errors), edges=of("edges", errors)).reset_index()
    return found.assign(family=found.pattern.replace("centre", "grid"), label=found.pattern)


def frames(scenes, soft_core):
    """Points of the diagram of frames: drawn by the triangle engine, back to back and alone, and drawn by the soft core."""
    size = scenes.width.astype(str) + "×" + scenes.height.astype(str)
    ways = [("gateware, back to back", scenes.cycles_frame), ("gateware, alone", scenes.cycles_alone), ("soft core", soft_core)]
    points = [
        scenes.assign(family=size + ", " + way, cost=cycles, shipped=number == 0, label=scenes.scene if number == 0 else None)
        for number, (way, cycles) in enumerate(ways)
    ]
    points = pd.concat(points)
    return points[points.cost.notna()].sort_values(["width", "family"], kind="stable")


def kernels(all_kernels, family):
    """The kernels of a family with an error and a cost, in groups: other libraries, Newton steps, and the rest."""
    members = all_kernels[(all_kernels.family == family) & (all_kernels.max_err > 0)]
    members = members[members.bits.notna() | members.cycles_median.notna()]
    names = members.config.str.partition(": ")
    is_table = members.config.str.contains("Newton|entries")
    group = names[0].where(names[1] != "", np.where(is_table, "tables and Newton steps", "integers"))
    return members.assign(group=group, short=names[2].where(names[1] != "", members.config))


def cores(cells, frames):
    """The variants of the soft core with their firmware: cells, and the soft core's part of each scene's frame in cycles and, at the
    variant's own clock rate, in ms, also relative to the default variant. The family "Pareto front" has those that no other beats in both
    LUTs and time. A variant may have frames, but no cells."""
    # The first rows of a variant are those with its own firmware.
    own = frames.drop_duplicates(["variant", "scene"])
    cycles, whole = (own.pivot(index="variant", columns="scene", values=part).loc[own.variant.unique()] for part in ("soft_core", "cycles"))
    found = cells.set_index("variant").reindex(cycles.index)
    default = found.index[0]
    times = cycles.div(1e3 * found.mhz, axis=0)

    def relative(figures):
        return np.exp(np.log(figures / figures.loc[default]).mean(axis=1))

    found["ratio"] = found.mhz / found.mhz[default]
    found["cycles"], found["time"] = relative(cycles), relative(times)
    is_behind = [((found.lut <= one.lut) & (found.time <= one.time) & ((found.lut < one.lut) | (found.time < one.time))).any()
                 for one in found.itertuples()]
    found["family"] = np.where(is_behind, found.index, "Pareto front")
    found["shipped"] = found.index == default
    return found.join([cycles, times.add_suffix(" ms"), whole.add_suffix(" frame")]).reset_index()


def counterless(frames):
    """The soft core's part of frames of the default variant with the firmware that reads the cycles of `timer0`, relative to its own
    firmware: the mean, and the largest difference of a scene."""
    default = frames[frames.variant == frames.variant.iloc[0]]
    has_counter = default.features.isna()
    both = default[~has_counter].merge(default[has_counter], on="scene")
    ratios = both.soft_core_x / both.soft_core_y
    return {"mean": np.exp(np.log(ratios).mean()), "largest": (ratios - 1).abs().max()}


def words(pictures):
    """The worst errors of each set of word lengths, by kind of field."""
    lengths = ["component", "direction", "inverse", "parameter", "outline", "along"]
    kinds = np.select([pictures.scene.str.startswith("menger"), pictures.scene.str.contains("sphere|moving|lattice")],
                      ["sponge", "round"], "flat")
    pictures = pictures.assign(kind=kinds, pixels=pictures.false_hits + pictures.false_misses)
    for (family, *bits), members in pictures.groupby(["family", *lengths], sort=False):
        worst = members.groupby("kind")[["wrong_faces", "depth_median", "depth_p99", "normal_p99"]].max()

        def errors(text, *places):
            found = [worst[column].get(kind, np.nan) for column, kind in places]
            return ", ".join(text(error) for error in found if not pd.isna(error))

        def depths(kind):
            return errors(lambda error: sci(error, 1), ("depth_median", kind), ("depth_p99", kind))

        yield {
            "family": family,
            "bits": dict(zip(lengths, bits)).get(family, ", ".join(map(str, bits))),
            "pictures": len(members),
            "pixels": members.pixels.sum(),
            "faces": errors(lambda error: f"{100 * error:.4f} %", ("wrong_faces", "sponge"), ("wrong_faces", "flat")),
            "depths": [depths(kind) for kind in ("sponge", "flat", "round")],
            "normals": errors(lambda error: f"{error:.3f}°", ("normal_p99", "round")),
        }


def cases(rates):
    """The measured cases of the raymarcher, with the slowest pose of each view, the only pose drawn back to back."""
    found = []
    columns = ["field", "stereo", "width", "height", "lanes", "clock", "at_least", "aim"]
    for key, poses in rates.groupby(columns, sort=False, dropna=False):
        case = rows(pd.DataFrame([key], columns=columns))[0]
        views = poses[poses.cycles_frame.notna()].assign(
            poses=poses.groupby("view").view.transform("size"),
            mean_alone=poses.groupby("view").cycles_alone.transform("mean"),
        )
        size = f"{case['width']}×{case['height']}"
        name = [case["field"], 2 if case["stereo"] else 1, size, case["lanes"]]
        rate = 1e6 * case["clock"] / views.cycles_frame.max()
        found.append(case | {"name": " | ".join(map(str, name)), "rate": rate, "views": rows(views)})
    return found


# Scenes of fields that are drawn by exits: name, number of eyes, width of the picture, required frames a second, and goal.
SCENES = [("cubes", 1, 640, 150, 190), ("poor-mans-vr", 2, 640, 180, 250), ("cubes", 1, 1280, 30, 60),
          ("menger", 1, 1280, 30, 60), ("mesh-in-field", 1, 1280, 30, 60), ("poor-mans-vr", 2, 1280, 30, 60)]


def targets(rates, cycles, marching):
    """Frames a second of fields that are drawn by exits, in the slowest view: with marching rays, with marching rays that start at
    cones, and with exits. A rate is None if it was not measured."""

    def slowest(frames):
        return CLOCK / frames.max() if len(frames) else None

    def row(name, same, spent, at_least, aim):
        before = marching[same]
        starts = [slowest(before[before.cones == cones].cycles) for cones in (False, True)]
        return {"name": name, "marching": starts[0], "cones": starts[1], "exits": CLOCK / spent, "at_least": at_least, "aim": aim}

    for case in cases(rates):
        stereo = marching.stereo.isna() if case["stereo"] is None else marching.stereo == case["stereo"]
        same = (marching.scene == case["field"]) & stereo & (marching.width == case["width"]) & (marching.lanes == case["lanes"])
        if same.any():
            spent = max(view["cycles_frame"] for view in case["views"])
            yield row(case["name"], same, spent, case["at_least"], case["aim"])
    for scene, eyes, width, at_least, aim in SCENES:
        measured = cycles[(cycles.scene == scene) & (cycles.width == width)]
        name = f"scene `{scene}` | {eyes} | {width}×{width * 9 // 16} | 2"
        yield row(name, (marching.scene == scene) & (marching.width == width), measured.cycles.iloc[0], at_least, aim)


def beside(pictures, marching):
    """The pictures by exits, each with the figures of its marching rays, named `marching_COLUMN`."""
    exits = pictures[pictures.form == "exits"]
    return exits.merge(marching.rename(columns=lambda name: f"marching_{name}"), how="left",
                       left_on=["scene", "view", "width"], right_on=["marching_scene", "marching_view", "marching_width"])


def worst(beside, prefix=""):
    """The largest errors of pictures in the columns with a prefix."""
    column = beside.filter(regex=f"^{prefix}").rename(columns=lambda name: name.removeprefix(prefix))
    return {"undecided": int(column.undecided.sum()), "iou": column.iou.min(), "wrong_faces": column.wrong_faces.max(),
            "depth_p99": column.depth_p99.max()}


def best_clocks(clocks):
    """The clocks of each rate and scene: measured if available, otherwise computed."""
    return clocks.sort_values("measured", ascending=False, kind="stable").drop_duplicates(["rate", "scene"]).sort_index()


def rule_error(clocks):
    """Largest relative difference between computed and measured clocks."""
    both = clocks[clocks.measured].merge(clocks[~clocks.measured], on=["rate", "scene"])
    return (both.clocks_y / both.clocks_x - 1).abs().max()


def variants(forms, clocks, costs):
    """Forms of smooth shading with the rate of their pixels: errors, clocks, and LUTs and DSP48 slices in addition to an engine with flat
    shading."""
    sign = np.where(costs.shading == "flat", -1, 1)
    added = costs[["LUT", "DSP48"]].mul(sign, axis=0).groupby(costs.engine).sum()
    divisions = costs[costs.division_dsp > 0].groupby("engine")[["division_lut", "division_dsp"]].first().set_axis(["LUT", "DSP48"], axis=1)
    eight = "eight divisions a clock, planes of the channels at once"
    # Cells saved by sequential instead of parallel computation of the channels' planes.
    saved = added.loc["a division a clock, planes of the channels at once"] - added.loc["a division a clock, planes one after the other"]

    def group(count):
        return added.loc[eight] - saved - (8 - count) / 8 * divisions.loc[eight]

    pixel, a_group, covered = "a pixel a clock", "a group a clock", "first and last covered pixel"
    shipped = "1024 entries of 17 bits"
    found = []
    for form, rate, label, cells in [
        ("linear on the screen", a_group, "affine", group(0)),
        ("first and last lane", a_group, "lanes", group(2)),
        (covered, a_group, "covered", group(2)),
        (covered, "a division a clock", "covered", group(1)),
        (shipped, a_group, "1024", group(8)),
        (shipped, "two pixels a clock", "1024", added.loc["Glint"] + divisions.loc["Glint"]),
        ("16 entries of 11 bits", pixel, "16", None),
        ("64 entries of 13 bits", pixel, "64", None),
        ("256 entries of 15 bits", pixel, "256", None),
        (shipped, pixel, "1024", added.loc["Glint"]),
        ("4096 entries of 19 bits", pixel, "4096", None),
        ("64 entries and a Newton step", pixel, "Newton", None),
    ]:
        errors = forms[forms.form == form].assign(off=lambda rows: rows.differing * rows.pixels)
        worst = errors.groupby("stiff").agg({"max_err": "max", "steps": "max", "off": "sum", "pixels": "sum"})
        worst["differing"] = worst.off / worst.pixels
        common, stiff = rows(worst.sort_index())
        scenes = rows(best_clocks(clocks[clocks.rate == rate]))
        first = next(scene for scene in scenes if scene["scene"] == "icosphere:6 from 2")
        group_name = errors.family.iloc[0]
        found.append({
            "form": form, "rate": rate, "label": label, "group": group_name, "family": f"{group_name}, {rate}",
            "shipped": rate == pixel and errors.shipped.all(), "common": common, "stiff": stiff, "scenes": scenes,
            "max_err": errors.max_err.max(), "rms": errors.rms.max(), "cost": first["clocks"] / first["pixels"],
            "lut": cells.LUT if cells is not None else None, "dsp": cells.DSP48 if cells is not None else None,
            "is_built": rate == pixel,
        })
    return pd.DataFrame(found).astype({"lut": float, "dsp": float})


def blocks():
    """The cells of each block of the gateware, from the first table of docs/resources.md."""
    text = (ROOT / "docs/resources.md").read_text()
    table = next(block for block in text.split("\n\n") if block.startswith("|"))
    found = {}
    for line in table.splitlines()[2:]:
        name, lut, _, _, _, ff, dsp, bram, *_ = (cell.strip() for cell in line.split("|")[1:])
        found[name] = {"lut": lut, "ff": ff, "dsp": dsp, "bram": bram}
    return found


def index(read, blocks):
    """All configurations of all kernels: error, RMS, cost, and the configuration's block of the gateware."""
    parts = []

    def add(name, page, frame, *, error="max_err", rms="rms", cost="cycles_median", error_unit="", cost_unit="cycles", block=None, holds="",
            in_overview=False):
        cells = f"`{block}`: {blocks[block]['lut']}, {blocks[block]['dsp']}" if block else ""
        parts.append(pd.DataFrame({
            "name": name, "page": page, "config": frame.config, "shipped": frame.shipped, "error": frame.eval(error),
            "rms": frame.eval(rms) if rms else np.nan, "cost": frame.eval(cost).astype(float),
            "error_unit": error_unit, "cost_unit": cost_unit,
            "cells": [cells if holds in config else "" for config in frame.config], "in_overview": in_overview,
        }))

    sines = read("sine").drop_duplicates("kernel", keep="last")
    add("sine, cosine", "sine.md", sines.assign(config=sines.kernel + ", " + sines.word_length), in_overview=True)

    small = read("kernels")
    # A logarithm without a cost is a bound, not an alternative.
    small = small[~small.config.str.startswith("exact logarithm")]
    for family, name, anchor, block, holds in [
        ("reciprocal", "1/x", "reciprocal", "vertex_stage", "of vertices"),
        ("inverse root", "1/√x", "reciprocal-square-root", None, ""),
        ("root", "√x", "square-root", None, ""),
        ("division", "a/b", "division", "vertex_stage", "of vertices"),
        ("length", "length", "length-of-a-vector", "field_sphere", "of spheres"),
        ("unit", "unit vector", "vector-of-length-1", None, ""),
    ]:
        add(name, f"kernels.md#{anchor}", small[small.family == family], block=block, holds=holds, in_overview=True)
    for column, value, name, anchor, unit in [
        ("family", "depth", "stored depth", "stored-depth", "of the depth"),
        ("family", "colour", "stored colour", "stored-colour", "/255"),
        ("family", "fog", "share of fog", "fog", "/255"),
        ("family", "sky", "colour of a sky", "sky", "/255"),
        ("family", "luminance", "luminance", "luminance", "/255"),
        ("family", "line", "end of a line", "end-of-a-line", "px"),
        ("family", "round", "light on a sphere", "light-on-a-sphere", "/255"),
        ("family", "highlight", "highlight", "highlight", "/255"),
        ("family", "occlusion", "occlusion", "occlusion", "/255"),
        ("kernel", "vertex", "word of a vertex", "number-formats-of-the-pipeline", "px"),
        ("kernel", "basis", "word of the camera's axes", "number-formats-of-the-pipeline", "px"),
        ("kernel", "inverse", "word of 1/z", "number-formats-of-the-pipeline", "px"),
        ("kernel", "snap", "word of a position", "number-formats-of-the-pipeline", "px"),
        ("kernel", "normal", "word of a normal", "number-formats-of-the-pipeline", "/255"),
        ("kernel", "intensity", "word of an intensity", "number-formats-of-the-pipeline", "/255"),
    ]:
        add(name, f"kernels.md#{anchor}", small[small[column] == value], cost="bits", error_unit=unit, cost_unit="bits")

    geometry = read("geometry-precision")
    for family, name, anchor, unit, block in [
        ("matrix", "product of matrices", "model-matrices", "", None),
        ("normal", "turned normal", "normals", "", None),
        ("projection", "projection", "projection", "/256 px", "vertex_stage"),
    ]:
        add(name, f"geometry.md#{anchor}", geometry[geometry.family == family], error_unit=unit, block=block)

    forms = variants(read("gouraud-forms"), read("gouraud-clocks"), read("gouraud-cost"))
    forms["config"] = forms.family + " (" + forms.label + ")"
    add("smooth shading", "gouraud.md", forms, cost="cost", error_unit="steps of a channel", cost_unit="clocks a pixel",
        block="triangle_engine_smooth")

    forms = read("raymarch-form")
    forms["config"] = forms.family.where(forms.family == "exits", forms.family + ": " + forms.config)
    add("ray to a sponge", "raymarch.md", forms, error="depth_p99", rms=None, cost="cycles", error_unit="world units, p99 of depths",
        cost_unit="cycles a picture", block="raymarcher")

    methods = read("imu-methods").query("motion == 'tumble' and rate == 200")
    add("attitude, a sample", "imu.md", methods.assign(config=methods.method), error="error", rms=None, cost="cycles",
        error_unit="° after 20 s of tumbling, 200 Hz")
    filters = read("gesture-filters")
    filters["config"] = (filters["filter"] + " " + filters.parameters.fillna("")).str.strip()
    add("filter of a hand", "gesture.md", filters, error="rest", rms=None, cost="cycles", error_unit="° at rest, RMS")
    return pd.concat(parts, ignore_index=True)


def overview(index):
    """The Pareto-optimal configurations of each kernel on the soft core, in error and cycles."""

    def is_kept(choice):
        others = index[index.name == choice.name]
        is_beaten = ((others.cost < choice.cost) & (others.error <= choice.error)).any()
        return choice.shipped or not (is_beaten or np.isnan(choice.cost))

    shown = index[index.in_overview]
    shown = shown[[is_kept(choice) for choice in shown.itertuples(index=False)]]
    return shown.assign(label=shown.name.where(shown.shipped))


def cost(value):
    """A cost as text."""
    return fixed(value, 0 if value is not None and (value >= 100 or value == int(value)) else 2, "not measured")


def neighbours(choices, choice):
    """The most exact cheaper choice, and the cheapest more exact choice; choices without a cost come last."""
    cheaper = [other for other in choices if None not in (other["cost"], choice["cost"]) and other["cost"] < choice["cost"]]
    exacter = [other for other in choices if other["error"] < choice["error"]]
    return (
        min(cheaper, key=lambda other: other["error"], default=None),
        min(exacter, key=lambda other: (np.inf if other["cost"] is None else other["cost"], -other["error"]), default=None),
    )


def choices(index):
    """Glint's choice for each kernel, with the next cheaper and the next more exact choice."""
    for _, group in index.groupby("name", sort=False):
        everything = rows(group)
        for choice in rows(group[group.shipped].drop_duplicates(["error", "cost"])):
            near = neighbours(everything, choice)
            texts = [f"{other['config']}: {sci(other['error'], 1)}, {cost(other['cost'])}" if other else "none measured" for other in near]
            yield choice | {"cheaper": texts[0], "more_exact": texts[1]}
