"""Write the type stub of the compiled core.

Usage: stubs.py [FOLDER]   (default: python/photograd, where _core.pyi is committed)
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent / "python" / "photograd"
ROOT = PACKAGE.parents[1]
HEAD = "# Generated from the compiled module by tools/stubs.py. Do not edit.\n"
# pybind11's own containers say nothing about their content; a strict type checker wants it said.
BARE = re.compile(r"(-> |: |\[)(tuple|list|dict|collections\.abc\.Callable)(?=[:,)\]\n]| =)")
FULL = {
    "tuple": "tuple[typing.Any, ...]",
    "list": "list[typing.Any]",
    "dict": "dict[str, typing.Any]",
    "collections.abc.Callable": "collections.abc.Callable[..., typing.Any]",
}


def write_stub(folder: Path) -> Path:
    """Generate `_core.pyi` in `folder` from the installed module, and return its path.

    Raises:
        RuntimeError: the generator failed, or met a signature that it cannot write as Python types.
    """
    with tempfile.TemporaryDirectory() as scratch:
        command = [sys.executable, "-m", "pybind11_stubgen", "photograd._core", "-o", scratch]
        run = subprocess.run([*command, "--exit-code"], capture_output=True, text=True, check=False)
        if run.returncode != 0:
            raise RuntimeError(f"pybind11-stubgen failed:\n{run.stdout}{run.stderr}")
        text = (Path(scratch) / "photograd" / "_core.pyi").read_text(encoding="utf-8")
    text = BARE.sub(lambda match: match[1] + FULL[match[2]], text)
    target = folder / "_core.pyi"
    target.write_text(HEAD + text, encoding="utf-8")
    ruff = [sys.executable, "-m", "ruff", "format", "-q", "--config", str(ROOT / "pyproject.toml")]
    subprocess.run([*ruff, str(target)], check=True)
    return target


if __name__ == "__main__":
    print(write_stub(Path(sys.argv[1]) if len(sys.argv) > 1 else PACKAGE))
