from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from photograd_course.assignment.toml import read_toml
from photograd_course.build.kits import find_kit, kit_files, list_kits, public_files
from photograd_course.build.notebook import notebook_of
from photograd_course.build.toml_text import toml_key, toml_value
from photograd_course.errors import DtypeError, RangeError

from support.missing import need_module
from support.tree import ROOT

from .support import TOY, Broken


def test_the_kit_is_complete_and_holds_no_answer(scaffold: Path) -> None:
    files = kit_files(scaffold)
    assert set(files) == {"README.md", "answers.toml", "explore.ipynb", "explore.py", "light.py"}
    assert b"2.0 * x" not in b"".join(files.values())
    assert (
        b'raise NotImplementedError("17.1 twice: see the handout, section 1")' in files["light.py"]
    )


def test_pictures_and_adapters_come_along(broken: Broken) -> None:
    broken.add("figures/fig1_x.png", "picture")
    broken.add("figures/draft.svg", "no")
    broken.add("adapters.py", "import light\n")
    files = kit_files(broken.folder)
    assert {"figures/fig1_x.png", "adapters.py"} < set(files)
    assert "figures/draft.svg" not in files
    assert public_files(broken.folder)["adapters.py"] == files["adapters.py"]


def test_answers_wait_for_every_question(scaffold: Path, tmp_path: Path) -> None:
    (tmp_path / "answers.toml").write_bytes(kit_files(scaffold)["answers.toml"])
    table = read_toml(tmp_path / "answers.toml")
    assert table == {"student": "", "answers": {"17.p1": "", "17.q1": ""}}


def test_public_checks_hold_neither_hidden_ones_nor_keys(broken: Broken) -> None:
    tricky = 'text = "What \\"becomes\\" of \\\\sigma\\n?"'
    broken.change("questions.toml", 'text = "What becomes of -3?"', tricky)
    broken.change("questions.toml", 'id = "17.p1"', 'id = "17.p1"\nanswer = "a"')
    files = public_files(broken.folder)
    assert {path for path in files if path.endswith(".py")} == {
        "checks/__init__.py",
        "checks/task_1.py",
    }
    assert b"17.1.known" in files["checks/task_1.py"]
    assert b"17.1.random" not in b"".join(files.values())
    kit = find_kit("17", broken.folder.parent)
    assert [check.id for check in kit.bundle.checks] == ["17.1.known"]
    assert [(q.answer, q.because) for q in kit.bundle.questions] == [("", ""), ("", "")]
    assert kit.bundle.questions[0].text == 'What "becomes" of \\sigma\n?'
    assert kit.bundle.questions[0].options == ("-6", "6")
    assert kit.bundle.is_public
    assert kit.manifest.folder == Path("17_light")


@pytest.mark.parametrize("name", ["17", "light", "17_light"])
def test_an_assignment_goes_by_number_and_name(scaffold: Path, name: str) -> None:
    assert find_kit(name, scaffold.parent).manifest.id == "17"
    assert list_kits(scaffold.parent) == ["17_light"]


def test_the_environment_names_another_course(
    scaffold: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PHOTOGRAD_ASSIGNMENTS", str(scaffold.parent))
    assert list_kits() == ["17_light"]


def test_an_unknown_assignment_is_refused_with_those_that_exist(scaffold: Path) -> None:
    with pytest.raises(RangeError, match="17_light"):
        find_kit("18", scaffold.parent)


def test_a_planned_assignment_is_said_to_be_planned(scaffold: Path, tmp_path: Path) -> None:
    shutil.copytree(scaffold, tmp_path / scaffold.name)
    plan = '[[assignment]]\nid = "06"\ntitle = "The frame"\n\n[[assignment]]\nid = "17"\n'
    (tmp_path / "course.toml").write_text(plan, "utf-8")
    for name in ("06", "6"):
        with pytest.raises(RangeError, match=r"ready, got 06, The frame, which is planned .* 17"):
            find_kit(name, tmp_path)
    assert find_kit("17", tmp_path).manifest.id == "17"
    with pytest.raises(RangeError, match="photograd course: assignment: expected one that exists"):
        find_kit("18", tmp_path)


def test_line_ends_of_other_systems_make_the_same_kit(tmp_path: Path) -> None:
    copy = tmp_path / TOY.name
    shutil.copytree(TOY, copy)
    for path in copy.rglob("*.*"):
        path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert kit_files(copy) == kit_files(TOY)
    assert public_files(copy) == public_files(TOY)


SCRIPT = "# %% [markdown]\n# A title\n#\n# Text.\n\n# %%\nx = 1\n\nprint(x)\n"


def test_a_script_becomes_a_notebook() -> None:
    book = json.loads(notebook_of(SCRIPT))
    cells = [(cell["cell_type"], "".join(cell["source"])) for cell in book["cells"]]
    assert cells == [("markdown", "A title\n\nText."), ("code", "x = 1\n\nprint(x)")]
    assert notebook_of(SCRIPT) == notebook_of(SCRIPT)
    assert len({cell["id"] for cell in book["cells"]}) == 2


def test_the_notebook_has_the_cells_that_jupytext_makes() -> None:
    jupytext = need_module("jupytext", by_choice=True)
    theirs = [(cell.cell_type, cell.source) for cell in jupytext.reads(SCRIPT, "py:percent").cells]
    ours = json.loads(notebook_of(SCRIPT))["cells"]
    assert [(cell["cell_type"], "".join(cell["source"])) for cell in ours] == theirs


def test_toml_that_is_written_is_read_again(tmp_path: Path) -> None:
    table = {"a": [1, 2.5, "x\ty\x7f"], "01.p1": {"b c": True, "d": [0.25]}, "e": {}}
    text = "".join(f"{toml_key(key)} = {toml_value(value)}\n" for key, value in table.items())
    (tmp_path / "a.toml").write_text(text, encoding="utf-8")
    assert read_toml(tmp_path / "a.toml") == table
    with pytest.raises(DtypeError):
        toml_value(None)


def test_the_readme_says_how_to_work_where_there_are_questions() -> None:
    plain, asked = (
        kit_files(ROOT / "assignments" / name)["README.md"].decode("utf-8")
        for name in ("00_setup", "02_backpropagation")
    )
    assert "How to work" not in plain
    assert asked.splitlines()[0].startswith("# 02")
    for command in ("predict 02", "check 02", "questions 02", "submit 02"):
        assert f"photograd course {command}" in asked.split("## ")[0]
