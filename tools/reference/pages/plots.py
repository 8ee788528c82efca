"""Diagrams of the report as reproducible SVG files."""

import itertools

import matplotlib
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

from tables import sci

matplotlib.rcParams.update({
    "svg.hashsalt": "glint",
    "svg.fonttype": "none",
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 9,
    "axes.axisbelow": True,
    "axes.grid": True,
    # With a fixed position of the title, matplotlib does not search for one.
    "axes.titley": 1.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
})

# Colours dark enough for thin text.
COLOURS = ["#b01830", "#187830", "#1858a8", "#a05800", "#702090", "#484848", "#008088", "#886838"]
MARKERS = "os^Dv"
LABEL = 7.5


def axes(title, across, up, *, left=0.1, right=0.73, bottom=0.1, top=0.93):
    """Makes a diagram with margins for a legend and other texts around the axes."""
    figure = Figure(figsize=(9, 5.2))
    axis = figure.add_axes((left, bottom, right - left, top - bottom))
    axis.set_title(title, fontsize=12)
    axis.set_xlabel(across)
    axis.set_ylabel(up)
    return figure, axis


def scale(axis, values, above=0.06):
    """Makes an axis logarithmic, unless the values are within a decade; `above` is the fraction of the axis above the values."""
    low, high = min(values), max(values)
    ratio = above / (0.94 - above)
    if high < 10 * low:
        span = max(high - low, 0.1 * high)
        axis.axes.set(**{f"{axis.axis_name}lim": (low - 0.06 * span, high + ratio * span)})
    else:
        span = high / low
        axis.axes.set(**{f"{axis.axis_name}scale": "log", f"{axis.axis_name}lim": (low / span**0.06, high * span**ratio)})
        axis.set_major_locator(LogLocator(subs=[1, 2, 5] if span < 1000 else [1]))
        axis.set_minor_locator(NullLocator())
        axis.set_major_formatter(lambda value, _: sci(value, 0) if value < 1e-3 or value >= 1e5 else f"{value:,g}")


def work_precision(path, rows, *, title, across, up, error, cost, family, label=None):
    """Writes a diagram of costs against errors, given as expressions of the columns. A line joins the rows of a family, and a ring marks
    those that Glint uses. A row without a cost is an empty mark at the upper end."""
    points = rows.assign(error=rows.eval(error), cost=rows.eval(cost).astype(float), family=rows[family])
    points["label"] = rows[label].fillna("").astype(str) if label else ""
    figure, axis = axes(title, across, up)
    costs = points.cost.dropna()
    scale(axis.xaxis, points.error)
    unnamed = points[points.cost.isna()].label.str.len()
    scale(axis.yaxis, costs if len(costs) else [1, 10], 0.06 if unnamed.empty else 0.06 + LABEL * unnamed.max() / 500)
    styles = zip(itertools.cycle(COLOURS), itertools.chain.from_iterable(itertools.repeat(m, len(COLOURS)) for m in MARKERS))
    texts = []
    for (name, members), (colour, marker) in zip(points.groupby("family", sort=False), styles):
        line = members.dropna(subset="cost").sort_values("error", kind="stable")
        unknown = members[members.cost.isna()]
        if len(line):
            axis.plot(line.error, line.cost, marker=marker, markersize=4.5, linewidth=1.3, color=colour, label=name)
        ringed = line[line.shipped]
        axis.plot(ringed.error, ringed.cost, "o", markersize=11, markerfacecolor="none", markeredgecolor="black")
        texts += [(point.error, point.cost, point.label, colour) for point in line.itertuples() if point.label]
        if len(unknown):
            axis.plot(unknown.error, [1] * len(unknown), marker, markersize=5, markerfacecolor="white", color=colour, clip_on=False,
                      transform=axis.get_xaxis_transform(), label=None if len(line) else name)
        for point in unknown.itertuples():
            axis.annotate(point.label, (point.error, 1), (0, -6), ("data", "axes fraction"), "offset points", rotation=90,
                          ha="center", va="top", fontsize=LABEL, color=colour)
    if points.cost.isna().any():
        axis.plot([], [], "o", markersize=5, markerfacecolor="white", color="black", label="cost not measured")
    save_labelled(figure, axis, texts, path)


def save_labelled(figure, axis, texts, path):
    """Writes a diagram with a label beside each point, at the position with the least overlap."""
    if len(axis.get_legend_handles_labels()[1]) > 1:
        axis.legend(loc="upper left", bbox_to_anchor=(1.01, 1.02), fontsize=8)
    places = [axis.transData.transform(text[:2]) * 72 / figure.dpi for text in texts]
    taken = [(x - 4, y - 4, x + 4, y + 4) for x, y in places]
    frame = axis.get_window_extent().transformed(figure.dpi_scale_trans.inverted())
    left, bottom, right, top = (72 * end for end in frame.extents)

    def hidden(box):
        covered = sum(max(0, min(box[2], other[2]) - max(box[0], other[0])) * max(0, min(box[3], other[3]) - max(box[1], other[1]))
                      for other in taken)
        outside = max(0, left - box[0]) + max(0, box[2] - right) + max(0, bottom - box[1]) + max(0, box[3] - top)
        return covered + 20 * outside

    for (x, y, text, colour), (across, up) in zip(texts, places):
        width, height = 0.6 * LABEL * len(text), 1.15 * LABEL
        offsets = [(7, 4), (7, -height - 4), (-width - 7, 4), (-width - 7, -height - 4), (-width / 2, 8), (-width / 2, -height - 8),
                   (9, -height / 2), (-width - 9, -height / 2)]
        boxes = [(across + dx, up + dy, across + dx + width, up + dy + height) for dx, dy in offsets]
        best = min(range(len(boxes)), key=lambda number: hidden(boxes[number]))
        taken.append(boxes[best])
        axis.annotate(text, (x, y), offsets[best], textcoords="offset points", fontsize=LABEL, color=colour)
    figure.savefig(path, metadata={"Date": None})


def lines(path, rows, *, title, across, up, at, series, band, least=0.0):
    """Writes lines over a column, in front of a band from an expression's value to three times this value. A line has a name, an expression
    and, unless it has all rows, a query."""
    figure, axis = axes(title, across, up, right=0.98, bottom=0.2)
    scale(axis.xaxis, rows[at])
    values = [rows.eval(expression).abs().clip(lower=least) for _, expression, *_ in series] + [3 * rows.eval(band)]
    scale(axis.yaxis, pd.concat(values))
    floor = rows.drop_duplicates(at)
    axis.fill_between(floor[at], floor.eval(band), 3 * floor.eval(band), color="#d8d8d8",
                      label="noise alone, one to three standard deviations")
    for (name, expression, *query), colour in zip(series, COLOURS):
        line = rows.query(*query) if query else rows
        axis.plot(line[at], line.eval(expression).abs().clip(lower=least), label=name, color=colour, linewidth=1.3)
    axis.legend(loc="upper center", bbox_to_anchor=(0.5, -0.11), ncols=3)
    figure.savefig(path, metadata={"Date": None})


def bars(path, rows, *, title, across, label, tracks):
    """Writes a group of bars for each row, first row at the top. A track is a list of parts: name, start and length."""
    figure, axis = axes(title, across, "", left=0.15, right=0.97, bottom=0.16)
    axis.grid(axis="y", visible=False)
    colours = {}
    for place, row in enumerate(rows.to_dict("records")):
        height = 0.8 / len(row[tracks])
        for number, track in enumerate(row[tracks]):
            for name, start, length in track:
                is_new = name not in colours
                colour = colours.setdefault(name, COLOURS[len(colours)])
                axis.barh(place + 0.1 + number * height, length, height, start, align="edge", color=colour, label=name if is_new else None)
    axis.set(xlim=(0, 100), ylim=(len(rows), 0))
    axis.set_yticks([place + 0.5 for place in range(len(rows))], rows[label])
    axis.tick_params(axis="y", length=0)
    axis.legend(loc="upper center", bbox_to_anchor=(0.45, -0.11), ncols=5)
    figure.savefig(path, metadata={"Date": None})
