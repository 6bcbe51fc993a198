"""Limits on what an input file may ask for, and the one way to raise them: environment variables.

A file of a few bytes can declare terabytes. Readers compare what a file asks for with a limit
before they allocate anything. The error names the variable that raises the limit.
"""

from __future__ import annotations

import os
from dataclasses import dataclass

from .errors import RangeError, message


@dataclass(frozen=True)
class Limit:
    """The most that one input file may ask for.

    Attributes:
        variable: environment variable that overrides the default.
        default: the limit where the variable is not set.
        unit: what is counted, in the plural.
    """

    variable: str
    default: int
    unit: str

    def value(self) -> int:
        """The limit in force.

        Raises:
            RangeError: the variable is set to something that is no positive whole number.
        """
        text = os.environ.get(self.variable)
        if text is None:
            return self.default
        if not (text.isascii() and text.isdigit() and 0 < len(text) < 19 and int(text) > 0):
            raise RangeError(
                message("environment", self.variable, "a positive whole number", repr(text[:40]))
            )
        return int(text)

    def expected(self) -> str:
        """What an error says was expected."""
        return f"at most {self.value():,} {self.unit}"

    def remedy(self) -> str:
        """What an error says can be done."""
        return f"if the file is right, set {self.variable} to a larger number"


TOML_BYTES = Limit("PHOTOGRAD_MAX_TOML_BYTES", 4 << 20, "bytes of TOML")
PIXELS = Limit("PHOTOGRAD_MAX_PIXELS", 1 << 27, "pixels in an image")
MODEL_ELEMENTS = Limit(
    "PHOTOGRAD_MAX_ELEMENTS", 1 << 28, "vertices, triangles and texels in a mesh file"
)
EXPANSION = Limit("PHOTOGRAD_MAX_EXPANSION", 1 << 28, "bytes more than the file is long")
"""Memory for arrays that a file declares but does not hold: zeros of a sparse accessor, what an
archive unpacks to. What a file holds byte by byte needs no limit."""

SVG_BYTES = Limit("PHOTOGRAD_MAX_SVG_BYTES", 8 << 20, "bytes of SVG")
"""Reading takes at most some hundred times as much memory."""
CROSSINGS = Limit("PHOTOGRAD_MAX_CROSSINGS", 1 << 30, "steps over edges that cross in a drawing")

LIMITS = (PIXELS, MODEL_ELEMENTS, EXPANSION, TOML_BYTES, SVG_BYTES, CROSSINGS)
"""All of them; README and `photograd --help` list them."""
