"""Which tables of the report are older than the sources that they measure."""

import functools
import subprocess

import tables

# Paths of the sources, as git's pathspecs. They are among the paths whose last commit is a table's commit (`provenance.rs`); otherwise a
# table could be older than its sources as soon as it is measured.
SOURCES = {
    "RTL": ["gateware/rtl", "gateware/glint_soc", "gateware/requirements.txt"],
    "firmware": ["firmware", ":!firmware/examples", ":!firmware/embedded-3dgfx", ":(exclude,glob)firmware/*/tests/**", "Cargo.toml",
                 "Cargo.lock", "build.rs", "memory.x"],
    "model": ["firmware/core/src", "firmware/model/src"],
    "reference": ["tools/reference/src", ":!tools/reference/src/report", ":!tools/reference/src/bin"],
    "synthesis": ["gateware/resources", "gateware/yosys", "gateware/requirements.txt"],
}

# What measures tables again (the arguments of a job of the workflow; None for kept measurements of earlier designs), their sources, and
# the tables.
MEASURED = [
    ("sine", "firmware model reference", "sine"),
    ("kernels", "firmware model reference", "kernels"),
    ("geometry", "firmware model reference", "geometry-precision"),
    ("geometry", "model reference", "geometry-drift geometry-turns"),
    ("gouraud", "model reference", "gouraud gouraud-forms gouraud-colours"),
    ("gouraud", "RTL model", "gouraud-clocks"),
    ("gouraud", "RTL synthesis", "gouraud-cost"),
    ("textures", "model reference", "textures-runs textures-cache textures-filters textures-formats"),
    ("textures", "RTL firmware", "textures-engine"),
    ("triangle --study engine", "RTL firmware", "triangle"),
    ("triangle --study cpu", "RTL firmware", "triangle-cpu"),
    ("raymarch --study pictures", "RTL model reference", "raymarch"),
    ("raymarch --study rates", "RTL firmware", "raymarch-rates"),
    ("raymarch --study scenes", "RTL firmware", "raymarch-scenes"),
    ("raymarch --study words", "model reference", "raymarch-words"),
    ("raymarch --study fillet", "model reference", "raymarch-fillet"),
    (None, "RTL model reference", "raymarch-form raymarch-marching-pictures"),
    (None, "RTL firmware", "raymarch-marching"),
    ("quality --study errors", "model reference", "quality"),
    ("quality --study cycles", "RTL firmware", "quality-cycles"),
    ("antialiasing --study errors", "model reference", "antialiasing antialiasing-patterns antialiasing-dither antialiasing-light"),
    ("antialiasing --study cycles", "RTL firmware", "antialiasing-cycles"),
    (None, "model reference", "antialiasing-before"),
    ("timeline", "RTL firmware", "timeline"),
    ("cpu --study cores", "synthesis", "cpu-cores"),
    ("cpu --study frames", "RTL firmware", "cpu"),
    ("imu", "model reference", "imu imu-filters"),
    ("imu", "firmware model reference", "imu-methods"),
    ("gesture", "model reference", "gesture gesture-centre gesture-stiff"),
    ("gesture", "firmware model reference", "gesture-filters"),
    ("long --study orbit", "firmware reference", "long-orbit"),
    ("long --study uptime", "firmware", "long-uptime"),
    ("long --study rest", "firmware reference", "long-rest"),
    ("long --study turning", "firmware reference", "long-turning"),
]

# Tables without a commit: written anew with the pages, checked by tests, or measured together with a table that names its commit.
WITHOUT_COMMIT = ["constants", "stiff", "sine-reference", "imu-cycles", "imu-replay", "imu-stiff", "imu-time"]


def git(*arguments):
    """The exit code of a git command in the checkout."""
    return subprocess.run(["git", "-C", tables.ROOT, *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode


@functools.cache
def since(commit, source):
    """Whether the working tree has the source as it was at a commit: "current" or "older", or "unknown" if git lacks the commit."""
    # Outside of a repository, `git diff` would compare two files.
    if git("cat-file", "-e", f"{commit}^{{commit}}"):
        return "unknown"
    return {0: "current", 1: "older"}.get(git("diff", "--quiet", commit, "--", *SOURCES[source]), "unknown")


def states(read):
    """A row for each table and each of its commits: the state by source, "" for sources that the table does not measure."""
    for command, sources, names in MEASURED:
        for name in names.split():
            for commit in read(name).commit.unique():
                found = [since(commit, source) if source in sources.split() else "" for source in SOURCES]
                yield {"table": name, "commit": commit, "states": found, "command": command}
