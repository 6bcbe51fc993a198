"""The package of checks: where each check stands, and what of it leaves the folder."""

from __future__ import annotations

import sys
from collections.abc import Mapping

import pytest
from photograd_course.assignment.check_files import HIDDEN, check_files, public_check_files
from photograd_course.assignment.checks import load_check_modules, load_checks
from photograd_course.assignment.load import load_package
from photograd_course.assignment.manifest import read_manifest
from photograd_course.build.kits import find_kit, list_kits
from photograd_course.build.public import wheel_kits
from photograd_course.errors import IoError, SceneError

from support.tree import ROOT

from .support import TOY, Broken

FOLDERS = sorted(path.parent for path in (ROOT / "assignments").glob("*/assignment.toml"))
PACKAGE = {"__init__.py": "", "a.py": "x = 1\n", "hidden/__init__.py": "", "hidden/b.py": ""}


def loaded(**texts: str) -> Mapping[str, object]:
    modules = load_package("made", {**PACKAGE, "hidden/b.py": texts["b"]})
    return vars(modules["hidden/b.py"])


def test_files_of_a_package_import_each_other() -> None:
    assert loaded(b="from ..a import x\n")["x"] == 1


def test_a_package_leaves_nothing_behind() -> None:
    before, finders = set(sys.modules), list(sys.meta_path)
    with pytest.raises(ZeroDivisionError):
        loaded(b="from ..a import x\nx / 0\n")
    assert {name for name in sys.modules if name.startswith("made")} == set()
    assert set(sys.modules) == before
    assert sys.meta_path == finders


def test_each_loading_has_modules_of_its_own() -> None:
    one, two = (load_package("made", PACKAGE)["a.py"] for _ in range(2))
    assert one is not two
    assert one.__name__ != two.__name__


def test_another_module_of_the_name_is_not_taken() -> None:
    """What a submission calls its files changes nothing."""
    sys.modules["made"] = sys.modules["made.a"] = sys
    try:
        assert loaded(b="from ..a import x\n")["x"] == 1
    finally:
        del sys.modules["made"], sys.modules["made.a"]


def test_checks_are_in_the_order_of_tasks_public_ones_first() -> None:
    ids = [check.id for check in load_checks(read_manifest(TOY))]
    assert ids == ["90.1.value", "90.1.hidden", "90.2.differences", "90.2.cost", "90.3.services"]


@pytest.mark.parametrize(
    ("path", "old", "new", "says"),
    [
        ("task_1.py", "points=40,\n", 'points=40,\n    visibility="hidden",\n', "checks/hidden/t"),
        ("task_1.py", "points=40,\n", 'points=40,\n    visibility="secret",\n', "checks/hidden/t"),
        ("task_1.py", '"17.1.known"', '"17.9.known"', "17.9"),
        ("hidden/task_1.py", '"17.1.random"', '"17.1.known"', "it occurs twice"),
    ],
)
def test_a_check_out_of_place_is_refused(
    broken: Broken, path: str, old: str, new: str, says: str
) -> None:
    broken.change(f"checks/{path}", old, new)
    with pytest.raises(SceneError, match=says):
        load_checks(read_manifest(broken.folder))


def test_a_public_check_in_the_hidden_folder_is_refused(broken: Broken) -> None:
    text = (broken.folder / "checks" / "task_1.py").read_text("utf-8")
    broken.add("checks/hidden/task_1.py", text.replace("17.1.known", "17.1.more"))
    with pytest.raises(SceneError, match=r"a public check of task 17\.1 in checks/task_1"):
        load_checks(read_manifest(broken.folder))


def test_a_check_in_the_file_of_another_task_is_refused(broken: Broken) -> None:
    checks = broken.folder / "checks"
    (checks / "task_1.py").rename(checks / "common.py")
    broken.change("checks/hidden/task_1.py", "..task_1", "..common")
    with pytest.raises(SceneError, match=r"checks/task_1\.py, got checks/common\.py"):
        load_checks(read_manifest(broken.folder))


def test_a_folder_without_checks_is_refused(broken: Broken) -> None:
    (broken.folder / "checks" / "__init__.py").unlink()
    with pytest.raises(IoError, match="a package checks/"):
        load_checks(read_manifest(broken.folder))


@pytest.mark.parametrize("folder", [TOY, *FOLDERS], ids=lambda folder: folder.name)
def test_no_hidden_check_and_no_helper_of_one_is_in_a_kit(folder) -> None:
    modules = load_check_modules(read_manifest(folder))
    hidden = [module for path, module in modules.items() if path.startswith(HIDDEN)]
    assert hidden or folder.name == "00_setup"
    shipped = b"\n".join(wheel_kits(folder).values()).decode("utf-8", errors="replace")
    own = {
        name for module in hidden for name, value in vars(module).items() if is_own(value, module)
    }
    assert [name for name in own if f"def {name}(" in shipped] == []
    assert not any("hidden" in path for path in wheel_kits(folder))


def is_own(value: object, module: object) -> bool:
    body = getattr(value, "body", value)
    return getattr(body, "__module__", None) == getattr(module, "__name__", "")


def test_public_checks_load_without_the_hidden_ones() -> None:
    for folder in FOLDERS:
        kit = find_kit(folder.name, folder.parent)
        public = [c.id for c in load_checks(read_manifest(folder)) if c.visibility == "public"]
        assert [check.id for check in kit.bundle.checks] == public
    assert len(list_kits(ROOT / "assignments")) == len(FOLDERS)


def test_public_files_are_those_outside_of_the_folder_hidden() -> None:
    everything, public = check_files(TOY), public_check_files(TOY)
    assert {path for path in everything if path not in public} == {
        "checks/hidden/__init__.py",
        "checks/hidden/task_1.py",
        "checks/hidden/task_2.py",
    }
