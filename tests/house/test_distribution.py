"""What is handed on: versions that agree, constraints, notices, workflow and recipe."""

from __future__ import annotations

import re
import sys
import tomllib
import zipfile
from pathlib import Path
from typing import Any

import pytest
import yaml

from support.missing import missing, need_module
from support.tree import ROOT

sys.path.insert(0, str(ROOT / "tools"))
try:
    import constraints
    import notices
finally:
    sys.path.pop(0)

CORE, COURSE = ROOT / "pyproject.toml", ROOT / "python" / "photograd_course" / "pyproject.toml"
STATED = {
    "pyproject.toml": r'^version = "(.*)"$',
    "python/photograd_course/pyproject.toml": r'^version = "(.*)"$',
    "python/photograd/__init__.py": r'^__version__ = "(.*)"$',
    "python/photograd/_core.pyi": r'^__version__: str = "(.*)"$',
    "python/photograd_course/src/photograd_course/__init__.py": r'^__version__ = "(.*)"$',
    "CMakeLists.txt": r"^project\(photograd VERSION (\S+) ",
    "CITATION.cff": r"^version: (.*)$",
    "CHANGELOG.md": r"^## (\d+\.\d+\.\d+)",
    "README.md": r"photograd_course-(\S+?)-py3",
    "docs/tutorials/teach_with_it.md": r"photograd_course-(\S+?)-py3",
    "recipe/recipe.yaml": r'^  version: "(.*)"$',
}
PACKED = {  # what cpp/CMakeLists.txt looks for, as packages of conda-forge
    "embree": "embree",
    "TBB": "tbb-devel",
    "glm": "glm",
    "OpenVDB": "openvdb",
}


def project(path: Path) -> dict[str, Any]:
    found: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf-8"))["project"]
    return found


def versions_of_python(path: Path) -> list[str]:
    lines = project(path)["classifiers"]
    return re.findall(r"Python :: (3\.\d+)$", "\n".join(lines), re.MULTILINE)


def parsed(name: str) -> Any:
    return yaml.safe_load((ROOT / name).read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", STATED)
def test_the_version_is_the_same_wherever_it_is_stated(name: str) -> None:
    text = (ROOT / name).read_text(encoding="utf-8")
    found = re.findall(STATED[name], text, re.MULTILINE)
    assert found[:1] == [project(CORE)["version"]]


@pytest.mark.usefixtures("core")
def test_the_compiled_core_is_of_this_version() -> None:
    from photograd import _core

    assert _core.__version__ == project(CORE)["version"]


def test_constraints_name_all_that_is_required_in_versions_that_will_do() -> None:
    text = constraints.FILE.read_text(encoding="utf-8")
    assert len(re.findall(r"^\S+==\d", text, re.MULTILINE)) > 20
    for name in ("latex2mathml", "mdit-py-plugins"):
        need_module(name.replace("-", "_"), by_choice=True)  # an instructor's, not everybody's
    assert constraints.faults(text) == []
    assert constraints.faults(re.sub(r"^numpy==.*$", "", text, flags=re.MULTILINE)) == [
        "no line for numpy"
    ]
    old = re.sub(r"^numpy==[^;\n]+", "numpy==1.20", text, flags=re.MULTILINE)
    assert all(fault.startswith("numpy==1.20, but numpy") for fault in constraints.faults(old))
    assert constraints.faults(old)


def test_names_of_packed_libraries_are_told_from_others() -> None:
    names = [
        "photograd/_core.cpython-311-x86_64-linux-gnu.so",
        "photograd.libs/libtbb-3b9ab3fc.so.12.8",
        "photograd.libs/libembree3-2f1d0e61.so.3",
        "photograd/.dylibs/libopenvdb.12.0.dylib",
        "photograd.libs/.load-order-photograd",
        "photograd/commands.py",
    ]
    found = notices.bundled(names)
    assert found == ["libembree3-2f1d0e61.so.3", "libopenvdb.12.0.dylib", "libtbb-3b9ab3fc.so.12.8"]
    assert [notices.original(name) for name in found] == [
        "libembree3.so.3",
        "libopenvdb.12.0.dylib",
        "libtbb.so.12.8",
    ]


def test_a_library_without_a_license_stops_the_wheel(monkeypatch: pytest.MonkeyPatch) -> None:
    known = notices.Package("tbb", "1", "https://example.org", "Apache")
    monkeypatch.setattr(notices, "owner", {"libtbb.so.12": known}.get)
    monkeypatch.setattr(notices, "debian_package", lambda _: known)
    text = notices.notices(["libtbb-3b9ab3fc.so.12"])
    assert notices.listed(text) == ["libtbb-3b9ab3fc.so.12"]
    assert "Apache" in text
    with pytest.raises(ValueError, match=r"got none of \['libnew-00000000.so'\]"):
        notices.notices(["libnew-00000000.so"])


def test_a_packed_library_of_conda_is_found_with_its_license(tmp_path: Path) -> None:
    licenses = tmp_path / "pkgs" / "info" / "licenses"
    licenses.mkdir(parents=True)
    (licenses / "LICENSE").write_text("of Embree", encoding="utf-8")
    (tmp_path / "conda-meta").mkdir()
    (tmp_path / "conda-meta" / "embree.json").write_text(
        '{"name": "embree", "version": "4", "url": "https://x", "files": ["lib/libembree4.so.4"],'
        f' "extracted_package_dir": "{tmp_path / "pkgs"}"}}',
        encoding="utf-8",
    )
    found = notices.conda_owner("libembree4.so.4", tmp_path)
    assert found is not None
    assert (found.name, found.text) == ("embree", "of Embree")
    assert notices.conda_owner("libtbb.so.12", tmp_path) is None


def test_wheels_in_dist_name_each_library_that_they_carry() -> None:
    wheels = sorted((ROOT / "dist").glob("photograd-*.whl"))
    if not wheels:
        missing("dist/ holds no wheel of the core (./run wheel)", by_choice=True)
    for wheel in wheels:
        with zipfile.ZipFile(wheel) as archive:
            names = archive.namelist()
            (file,) = [name for name in names if name.endswith(f"/licenses/{notices.NAME}")]
            text = archive.read(file).decode()
            (record,) = [name for name in names if name.endswith(".dist-info/RECORD")]
            assert file in archive.read(record).decode()
        carried = notices.bundled(names)
        assert len(carried) > 5
        assert notices.listed(text) == carried
        assert all(f"- {name} (headers): " in text for name in ("GLM", "Boost", "pybind11"))


def test_the_workflow_builds_what_the_project_names() -> None:
    steps = parsed(".github/workflows/wheels.yml")["jobs"]["core"]["steps"]
    (build,) = [step for step in steps if "cibuildwheel" in step.get("uses", "")]
    tags = build["env"]["CIBW_BUILD"].split()
    assert [f"3.{tag[3:5]}" for tag in tags] == versions_of_python(CORE)
    matrix = parsed(".github/workflows/wheels.yml")["jobs"]["core"]["strategy"]["matrix"]
    assert {name.partition("-")[0] for name in matrix["system"]} == {"ubuntu", "macos", "windows"}


def test_what_compiles_the_core_is_written_down() -> None:
    text = (ROOT / "cpp" / "CMakeLists.txt").read_text(encoding="utf-8")
    asked = set(re.findall(r"find_package\((\w+)", text))
    assert asked == PACKED.keys() | {"pybind11", "doctest"}  # pip's; of tests alone
    rows = parsed(".github/environment.yml")["dependencies"]
    assert set(PACKED.values()) < {row.split()[0] for row in rows}
    core = parsed("recipe/recipe.yaml")["outputs"][1]["requirements"]
    host = {row.split()[0] for row in core["host"]}
    assert set(PACKED.values()) | {"pybind11", "scikit-build-core"} < host


def test_the_recipe_requires_what_the_distributions_require() -> None:
    renamed = {"matplotlib": "matplotlib-base", "openexr": "openexr-python"}
    sys.path.insert(0, str(ROOT / "python"))
    try:
        from dependencies import REQUIREMENTS
    finally:
        sys.path.pop(0)
    outputs = parsed("recipe/recipe.yaml")["outputs"]
    for output, lines in zip(outputs, (project(COURSE)["dependencies"], REQUIREMENTS), strict=True):
        wanted = set()
        for line in lines:
            name, _, rest = line.partition(";")[0].strip().partition(">=")
            wanted.add(f"{renamed.get(name.lower(), name.lower())} >={rest}")
        assert wanted <= set(output["requirements"]["run"])


def test_workflow_and_recipe_say_that_they_were_not_run() -> None:
    for name in (".github/workflows/wheels.yml", "recipe/recipe.yaml"):
        head = (ROOT / name).read_text(encoding="utf-8").partition("\n\n")[0]
        assert "NOT RUN" in head
