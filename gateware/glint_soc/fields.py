"""Descriptions of the flat fields of the raymarcher, one for each.

`cargo xtask pac` generates `rtl/raymarch/fields_pkg.sv` (masks) from these descriptions. They also determine the values of `solid.kind` and
the bits of `caps.flat` (and with them the PAC and the checks of the driver), the builds, and the variants that are tested and measured.
docs/adding-a-field.md lists the steps to add a field.
"""

from dataclasses import dataclass

from .packed import number, package
from .rtl import RTL


@dataclass(frozen=True)
class FlatField:
    """A flat field.

    `text` names the fields that use it, in the plural, for error messages. A field with `marches` can be joined with spheres by
    fillets, and the module `field_NAME` computes its distance. With `octants`, faces are perpendicular to the diagonals (±1, ±1,
    ±1), and `surface` is {z, y, x}, where a bit is 1 if that component of the normal is positive. Otherwise faces are perpendicular
    to the axes, and `surface` is {axis, positive}.
    """

    name: str
    text: str
    marches: bool = False
    octants: bool = False


FLAT_FIELDS = (
    FlatField("menger", "sponges", marches=True),
    FlatField("box", "boxes, cubes and planes", marches=True),
    FlatField("octahedron", "octahedra", octants=True),
)
"""All flat fields, by their numbers in `solid.kind`. Field 0 is the sponge; the number of its levels is a separate build option."""

NAMES = tuple(flat.name for flat in FLAT_FIELDS)

KIND_BITS = max(1, (len(FLAT_FIELDS) - 1).bit_length())
"""Width of `solid.kind` in bits."""


def mask(names):
    """Returns the parameter FIELDS of a build with the fields `names`: bit k is set if field k is built."""
    return sum(1 << NAMES.index(name) for name in names)


def has_octants(names):
    """Returns whether a build with the fields `names` has fields whose faces are perpendicular to the diagonals."""
    return any(flat.octants for flat in FLAT_FIELDS if flat.name in names)


def has_marching(names):
    """Returns whether a build with the fields `names` has fields that fillets join with spheres."""
    return any(flat.marches for flat in FLAT_FIELDS if flat.name in names)


def files():
    """Returns the text of each generated file, by path."""
    return {RTL / "raymarch" / "fields_pkg.sv": package("fields_pkg", "fields.py", "Masks of flat fields.", [
        "\n".join([
            number("ALL", mask(NAMES), "Masks of all fields, of fields with faces perpendicular to the diagonals, and of fields that "
                                       "fillets can join with spheres."),
            number("OCTANTS", mask(flat.name for flat in FLAT_FIELDS if flat.octants)),
            number("MARCHED", mask(flat.name for flat in FLAT_FIELDS if flat.marches)),
            *(number(flat.name.upper(), 1 << field, "Mask of each field." if field == 0 else "")
              for field, flat in enumerate(FLAT_FIELDS)),
        ]),
    ])}
