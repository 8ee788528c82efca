"""The builds for the built-in scenes: sizes of gateware and firmware, and cycles of their frames.

`cargo xtask resources --scenes` makes the builds and describes them in a file: `full` is the length in bytes of the firmware with
all parts, `ulx3s` has, by type, the cells of the build for all scenes on the ULX3S and the cells of its FPGA, and `builds` lists
the builds.
"""

from .budget import RESOURCES, amounts, number

ALL = "all"
"""Name of the build for all scenes."""

_FIRMWARE_SHARE = 0.5
"""Limit of the length of the firmware for a single scene, as a share of the firmware with all parts."""

_WORD, _PIXEL = 16, 2
"""Sizes in bytes: a word of the engines' memory ports, and a pixel of the frame buffer."""

_REFRESH = 60
"""Pictures per second that scan-out reads."""

_LIMITED = {"lut": "lut", "ff": "ff", "dsp": "dsp48", "ramb36": "ramb36"}
"""Limits of a scene file that are resources."""

_CYCLES = ("cycles", "cycles_soft_core", "cycles_geometry", "cycles_raster", "cycles_stalled")


def rows(data, sizes):
    """Returns the builds with their amounts of resources. Each frame gets two more figures: `rate`, the frames per second without
    pauses between frames, and `memory`, the memory traffic in MB/s of the engines at this rate and of scan-out."""
    found = []
    for build in data["builds"]:
        frame = build["frame"]
        if frame:
            rate = frame["clock"] / frame["cycles"]
            engines = (frame["words_read"] + frame["words_written"]) * _WORD * rate
            frame = frame | {"rate": rate, "memory": (engines + frame["pixels"] * _PIXEL * _REFRESH) / 1e6}
        found.append(build | {"amounts": amounts(sizes[build["name"]]), "frame": frame})
    return found


def contents(data, builds, budget):
    """Returns the contents for the template of the page."""
    every = next((build["amounts"] for build in builds if build["name"] == ALL), None)
    fits_ulx3s = all(used <= available for used, available in data["ulx3s"].values())
    gateware = [["scene", "LUT", "of all", "FF", "DSP48", "RAMB36", "slices", "fits the XC7S50", "the ULX3S", "build"]]
    firmware = [["scene", "image", "of full", "code", "constants", "variables", "stack"]]
    frames = [["scene", "cycles", "soft core", "geometry passes", "raster pass", "of these waiting for memory", "frames a second",
               "MB a second"]]
    for build in builds:
        name, amount, image = f"`{build['name']}`", build["amounts"], build["firmware"]
        # Only the build for all scenes is measured on the ULX3S. If it fits, a build that needs no more of any resource fits too.
        is_smaller = fits_ulx3s and every and all(amount[resource] <= every[resource] for resource in _LIMITED.values())
        gateware.append([
            name, number(amount["lut"]), f"{100 * amount['lut'] / every['lut'] if every else 0:.0f} %",
            *(number(amount[resource]) for resource in ("ff", "dsp48", "ramb36", "slices")), _fit(amount, budget.device),
            "yes" if is_smaller else "not measured", f"`{' '.join(build['options'])}`"])
        firmware.append([
            name, number(image["length"]), f"{100 * image['length'] / data['full']:.0f} %",
            *(number(image[part]) for part in ("code", "constants", "variables")),
            "" if image["stack"] is None else number(image["stack"])])
        if frame := build["frame"]:
            frames.append([name, *(number(frame[cycles]) for cycles in _CYCLES), number(frame["rate"] // 1), number(frame["memory"] // 1)])
    cells = [f"{number(used)} {name} ({100 * used / available:.0f} %)" for name, (used, available) in sorted(data["ulx3s"].items())]
    return {"gateware": gateware, "firmware": firmware, "frames": frames, "cells": ", ".join(cells)}


def _fit(amount, device):
    """Returns whether a build fits a device: "yes", or the resources that exceed the device."""
    shares = {RESOURCES[resource]: 100 * amount[resource] / device[resource] for resource in RESOURCES if resource in device}
    beyond = ", ".join(f"{name} {share:.0f} %" for name, share in shares.items() if share > 100)
    return f"no: {beyond}" if beyond else "yes"


def problems(builds, full):
    """Returns a line for each limit of a scene that its build violates: `fps` is a minimum, all other limits are maxima. The firmware
    of a single scene is limited to a share of the `full` bytes with all parts."""
    lines = []
    for build in builds:
        length = build["firmware"]["length"]
        if build["is_single"] and length > _FIRMWARE_SHARE * full:
            lines.append(f"{build['name']}: firmware: expected at most {100 * _FIRMWARE_SHARE:.0f} % of the {number(full)} bytes with all "
                         f"parts, measured {number(length)}")
        values = {"firmware": length, **{limit: build["amounts"][resource] for limit, resource in _LIMITED.items()}}
        if build["frame"]:
            values |= {"cycles": build["frame"]["cycles"], "fps": build["frame"]["rate"]}
        for name, limit in build["budget"].items():
            if name in values and (values[name] < limit if name == "fps" else values[name] > limit):
                lines.append(f"{build['name']}: {name}: budget {limit:.12g}, measured {number(values[name] // 1)}")
    return lines
