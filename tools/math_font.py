"""Cut a font for formulas down to what handouts may use, as WOFF2.

Usage: math_font.py texgyretermes-math.otf

Debian's package fonts-texgyre-math has the font. Needs fonttools with brotli:
pip install 'fonttools[woff]'.
"""

from __future__ import annotations

import sys
from pathlib import Path

TARGET = "python/photograd_course/src/photograd_course/build/page/mathematics.woff2"
CHARACTERS = (
    "U+20-7E,U+A0-FF,U+131,U+237,U+300-30C,U+20D7,"  # Latin, accents
    "U+391-3A9,U+3B1-3C9,U+3D1,U+3D5,U+3D6,U+3F0,U+3F1,U+3F5,"  # Greek
    "U+2010-2027,U+2032-2034,U+2044,U+2061-2064,U+2102,U+210E,U+2113,U+211D,U+2124,"
    "U+2190-2195,U+21A6,U+21D0-21D5,U+27F5-27FA,"  # arrows
    "U+2200-222F,U+2234-224D,U+2250-2265,U+226A-226B,U+2282-2287,U+2295-2299,U+22A4-22A5,"
    "U+22C5,U+22C6,U+22EE-22F1,U+2308-230B,U+23B0-23B1,U+239B-23B9,U+23DE,U+23DF,U+27E8-27E9,"
    "U+2016,U+1D400-1D467,U+1D6A4-1D6A5,U+1D6A8-1D71B,U+1D7CE-1D7D7"  # bold and slanted letters
)


def main() -> None:
    """Write the subset."""
    from fontTools.subset import main as subset

    root = Path(__file__).resolve().parent.parent
    options = ["--layout-features=*", "--no-hinting", "--desubroutinize", "--flavor=woff2"]
    target = f"--output-file={root / TARGET}"
    subset([sys.argv[1], f"--unicodes={CHARACTERS}", target, *options])


if __name__ == "__main__":
    main()
