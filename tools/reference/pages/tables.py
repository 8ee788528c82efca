"""Tables of the report: reading them, and formats of their cells."""

from pathlib import Path

import numpy as np
import pandas as pd

ROOT = Path(__file__).resolve().parents[3]
COMMITTED = ROOT / "docs/report"


def read(folder, name):
    """The table NAME of a folder. A table that the folder lacks is the committed one."""
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
    """A value as text: numbers without an exponent, nothing for an empty cell."""
    if value is None:
        return ""
    return np.format_float_positional(value, trim="-") if isinstance(value, float) else value


def sci(value, digits=None, missing=""):
    """A number with an exponent, and with so many digits after the point; as many as it has unless they are given."""
    if value is None:
        return missing
    exact = {"trim": "-"} if digits is None else {"precision": digits, "min_digits": digits, "unique": False}
    text = np.format_float_scientific(value, exp_digits=1, **exact)
    return text.replace("e+", "e").replace(".e", "e")


def fixed(value, digits=0, missing=""):
    """A number with so many digits after the point."""
    return missing if value is None else f"{value:.{digits}f}"


def measured(value):
    """A value, or that there is none."""
    return "not measured" if value is None else shown(value)


def bold(text, is_bold=True, mark="**"):
    """A text in bold, if it is to be."""
    return f"{mark}{shown(text)}{mark}" if is_bold else shown(text)


def italic(text, is_italic=True):
    """A text in italics, if it is to be."""
    return bold(text, is_italic, "*")


def groups(frame, *columns):
    """The values of some columns and the rows that share them, in the order of the table."""
    return [(key, rows(group)) for key, group in frame.groupby(list(columns), sort=False, dropna=False)]
