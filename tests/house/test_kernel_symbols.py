"""A kernel compiled for a newer processor must not lend a function to the rest of the program.

The linker keeps one copy of an inline function that several files emit. If one of them was compiled
for AVX-512 and its name is the same everywhere, an older processor may end up executing it. So
everything weak in such an object has to carry the instruction set in its name.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from support.missing import missing
from support.tree import ROOT

SETS = ["v3", "v4"]
WEAK = {"W", "V", "u", "w", "v"}


def own_symbol(instruction_set: str) -> re.Pattern[str]:
    """Mangled names in photograd::<set>: entities, their local statics and guards, type data."""
    length = len(instruction_set)
    return re.compile(rf"_Z(?:GV)?Z?(?:T[VIS])?N?[KVr]*9photograd{length}{instruction_set}")


def objects(instruction_set: str) -> list[Path]:
    tag = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    platform = sysconfig.get_platform().replace("-", "_")
    build = ROOT / "build" / f"{tag}-{tag}-{platform}"
    return sorted(build.rglob(f"photograd_kernels_{instruction_set}.dir/**/*.o"))


def weak_symbols(listing: str) -> list[str]:
    """Names that `nm -P` marks as weak or unique."""
    rows = (line.split() for line in listing.splitlines())
    return [row[0] for row in rows if len(row) > 1 and row[1] in WEAK]


@pytest.mark.parametrize("instruction_set", SETS)
def test_weak_symbols_carry_the_instruction_set(instruction_set: str) -> None:
    files = objects(instruction_set)
    if not files or shutil.which("nm") is None:
        missing("compiled kernels in build/, and nm, are not here")
    own = own_symbol(instruction_set)
    found = []
    for file in files:
        listing = subprocess.run(["nm", "-P", file], capture_output=True, text=True, check=True)
        symbols = listing.stdout.splitlines()
        assert any("march_dense" in line for line in symbols), f"{file.name} holds no kernel"
        found += [name for name in weak_symbols(listing.stdout) if not own.match(name)]
    assert found == []


def test_a_foreign_weak_symbol_is_seen() -> None:
    own, foreign, strong = "_ZN9photograd2v33expEf", "_ZSt3minIfERKT_S2_S2_", "_ZSt5table"
    listing = f"{own} W 0 2d\n{foreign} W 0 1e\n{strong} D 0 8\n"
    weak = weak_symbols(listing)
    assert weak == [own, foreign]
    assert [name for name in weak if not own_symbol("v3").match(name)] == [foreign]
