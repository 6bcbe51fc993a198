"""Put the stripped kits into a wheel: `photograd_course/kits/NN_name/{kit,checks}/`.

Runs wherever a wheel or an sdist is built, with nothing installed but what pyproject.toml asks for:
the stripping code is loaded without the package around it, which needs NumPy. An
editable install gets no kits; there they are stripped from `assignments/` when asked for.
"""

from __future__ import annotations

import importlib
import shutil
import sys
import tempfile
import types
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

HERE = Path(__file__).resolve().parent
SOURCE = HERE / "src" / "photograd_course"
ASSIGNMENTS = HERE.parents[1] / "assignments"
PLAN = "course.toml"
# What `build.public` uses, and the packages whose __init__ would import more.
PACKAGES = ("photograd_course", "photograd_course.assignment", "photograd_course.build")


class KitsHook(BuildHookInterface):
    """Strips every assignment into a temporary folder and includes it."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """See hatchling."""
        if version == "editable" or not ASSIGNMENTS.is_dir():
            return  # an sdist carries its kits inside of the package
        self._folder = Path(tempfile.mkdtemp(prefix="photograd-kits-"))
        top = "photograd_course" if self.target_name == "wheel" else "src/photograd_course"
        for path in write_kits(self._folder):
            inside = path.relative_to(self._folder).as_posix()
            build_data["force_include"][str(path)] = f"{top}/kits/{inside}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """See hatchling."""
        del version, build_data, artifact_path
        if hasattr(self, "_folder"):
            shutil.rmtree(self._folder, ignore_errors=True)


def write_kits(target: Path) -> list[Path]:
    """Write the kit and the public checks of every assignment; the files written."""
    wheel_kits = load_stripper()
    written = []
    if (ASSIGNMENTS / PLAN).exists():
        written.append(Path(shutil.copy(ASSIGNMENTS / PLAN, target / PLAN)))
    for folder in sorted(ASSIGNMENTS.iterdir()):
        if not (folder / "assignment.toml").exists():
            continue
        for inside, data in wheel_kits(folder, pages=True).items():
            path = target / folder.name / inside
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
            written.append(path)
    return written


def load_stripper() -> Any:
    """`photograd_course.build.public.wheel_kits`, without running any package's __init__."""
    before = {name: sys.modules.get(name) for name in PACKAGES}
    for name in PACKAGES:
        package = types.ModuleType(name)
        package.__path__ = [str(SOURCE.joinpath(*name.split(".")[1:]))]
        sys.modules[name] = package
    try:
        return importlib.import_module("photograd_course.build.public").wheel_kits
    finally:
        for name in [each for each in sys.modules if each.startswith("photograd_course")]:
            del sys.modules[name]
        sys.modules.update({name: module for name, module in before.items() if module})
