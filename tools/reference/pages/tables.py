"""Tables of the report: reading, and formats of cells."""

from pathlib import Path

import numpy as np
import pandas as pd

ROOT = Path(__file__).resolve().parents[3]
COMMITTED = ROOT / "docs/report"


def read(folder, name):
    """The table NAME of a folder, or the committed table if the folder has none."""
    path = Path(folder) / f"{name}.csv"
    return pd.read_csv(
        path if path.exists() else COMMITTED / path.name,
        dtype={"commit": str, "config": str, "value": str},
        keep_default_na=False,
        na_values=[""],
    )


def rows(frame):
    """The rows of a table as dictionaries. An empty cell is None."""
    return frame.astype(object).where(frame.notna(), None).to_dict("records")


def shown(value):
    """Formats a value: numbers without an exponent, an empty cell as an empty text."""
    if value is None:
        return ""
    return np.format_float_positional(value, trim="-") if isinstance(value, float) else value


def sci(value, digits=None, missing=""):
    """Formats a number with an exponent and `digits` digits after the point, by default all digits."""
    if value is None:
        return missing
    exact = {"trim": "-"} if digits is None else {"precision": digits, "min_digits": digits, "unique": False}
    text = np.format_float_scientific(value, exp_digits=1, **exact)
    return text.replace("e+", "e").replace(".e", "e")


def fixed(value, digits=0, missing=""):
    """Formats a number with `digits` digits after the point."""
    return missing if value is None else f"{value:.{digits}f}"


def measured(value):
    """Formats a value, or "not measured"."""
    return "not measured" if value is None else shown(value)


def bold(text, is_bold=True, mark="**"):
    """Formats a text, in bold if `is_bold`."""
    return f"{mark}{shown(text)}{mark}" if is_bold else shown(text)


def italic(text, is_italic=True):
    """Formats a text, in italics if `is_italic`."""
    return bold(text, is_italic, "*")


def groups(frame, *columns):
    """Groups of rows with equal values in some columns, in the order of the table."""
    return [(key, rows(group)) for key, group in frame.groupby(list(columns), sort=False, dropna=False)]
