"""Writes the pages of docs/report and their diagrams from the tables (CSV files) in a folder."""

import argparse
import re
from pathlib import Path

import pandas as pd
from jinja2 import Environment, FileSystemLoader, StrictUndefined

import figures
import plots
import state
import tables

TEMPLATES = Path(__file__).parent / "templates"


def cycles(row):
    """Minimum, median and maximum cycles of a kernel."""
    figures = [row[f"cycles_{name}"] for name in ("min", "median", "max")]
    return "not measured" if None in figures else " / ".join(map(str, map(tables.shown, figures)))


def duration(seconds):
    """Formats a time in seconds, minutes or hours."""
    for unit, length in [("h", 3600), ("min", 60), ("s", 1)]:
        if seconds >= length:
            return f"{tables.shown(seconds / length)} {unit}"


def cell(text):
    """Formats a text for a table cell: on one line, with messages as code."""
    text = text.replace("|", "\\|").replace("\n", " ")
    return f"refused: `{text.removeprefix('refused: ')}`" if text.startswith("refused: ") else text


def limit(value):
    """Formats a limit, with an exponent below 1/1000."""
    return tables.sci(value) if value < 1e-3 else tables.shown(value)


def environment(folder):
    """Makes the Jinja environment with the functions and filters of the templates."""

    def read(name):
        return tables.read(folder, name)

    def drawn(draw):
        def diagram(name, rows, *, title, **options):
            draw(folder / f"{name}.svg", rows, title=title, **options)
            return f"![{title}]({name}.svg)"

        return diagram

    def made(rows):
        first = rows.iloc[0]
        return f"Made at commit {first.commit} with {first.tools}."

    pages = Environment(loader=FileSystemLoader(TEMPLATES), undefined=StrictUndefined, finalize=tables.shown,
                        trim_blocks=True, lstrip_blocks=True)
    pages.globals.update(
        read=read, made=made, figures=figures, groups=tables.groups, concat=pd.concat,
        constants=dict(read("constants").set_index("name").value),
        states=state.states, sources=state.SOURCES, without_commit=state.WITHOUT_COMMIT,
        work_precision=drawn(plots.work_precision), lines=drawn(plots.lines), bars=drawn(plots.bars),
    )
    pages.filters.update(
        rows=tables.rows, shown=tables.shown, sci=tables.sci, fixed=tables.fixed, measured=tables.measured, bold=tables.bold,
        italic=tables.italic, cycles=cycles, duration=duration, limit=limit, cell=cell, choices=figures.choices, cost=figures.cost,
    )
    return pages


def main():
    parser = argparse.ArgumentParser(prog="pages", description=__doc__)
    parser.add_argument("--out", type=Path, default=tables.COMMITTED, metavar="DIR",
                        help="folder of tables, pages and diagrams; missing tables are read from docs/report [default: docs/report]")
    parser.add_argument("page", nargs="*", help="name of a page, such as sine [default: all]")
    arguments = parser.parse_args()
    pages = environment(arguments.out)
    for name in arguments.page or sorted(path.stem for path in TEMPLATES.glob("*.md")):
        # Collapse the blank lines of loops and macros.
        text = re.sub("\n{3,}", "\n\n", pages.get_template(f"{name}.md").render())
        (arguments.out / f"{name}.md").write_text(text.rstrip() + "\n")


if __name__ == "__main__":
    main()
