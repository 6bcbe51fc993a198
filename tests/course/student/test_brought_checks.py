"""What was brought along is looked at first, by its own checks, and a wrong function is named."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from photograd_course.build.kits import find_kit, list_manifests
from photograd_course.student.brought_checks import Looked, look_at_brought, uses_of, with_needs
from photograd_course.student.checking import check_here
from photograd_course.student.origins import owner_of
from photograd_course.student.record import Record
from photograd_course.student.uses import Uses

from support.tree import ROOT

from .small_course import WRONG, Semester

DONE = "    return float(np.sum(w * np.exp(-x)))\n"
ASSIGNMENTS = ROOT / "assignments"


@pytest.fixture
def third(semester: Semester) -> Semester:
    """92, finished, with all that it brings, and 90 and 91 beside it."""
    for folder in ("90_toy", "91_twice", "92_thrice"):
        for name in ("90_toy", "91_twice", "92_thrice"):
            if name <= folder:
                semester.put(f"{folder}/{name[3:]}.py", semester.solution(name))
    semester.put("92_thrice/answers.toml", "[answers]\n'92.p1' = 'a'\n")
    return semester


def spoil(semester: Semester, path: str) -> None:
    """A wrong weighted sum."""
    text = semester.text(path)
    assert DONE in text
    semester.put(path, text.replace(DONE, WRONG))


def checked(semester: Semester, *words: str, code: int = 1) -> str:
    return semester.course("check", "92", "--dir", "92_thrice", "--no-pictures", *words, code=code)


def test_what_is_right_is_said_once_and_not_run_again(
    third: Semester, monkeypatch: pytest.MonkeyPatch
) -> None:
    said = checked(third, code=0)
    assert "✓ toy.py of 90: what is used here passes its 1 check " in said
    assert "✓ twice.py of 91: what is used here passes its 1 check " in said
    assert "All green." in said

    def run(*_: object, **__: object) -> None:
        raise AssertionError

    monkeypatch.setattr("photograd_course.student.brought_checks.check_here", run)
    with pytest.raises(AssertionError):
        look(third, "92_thrice", b"# another text\n")
    assert len(look(third, "92_thrice").right) == 2


def look(semester: Semester, folder: str, more: bytes = b"") -> Looked:
    kit = find_kit(folder[:2])
    files = {path.name: path.read_bytes() for path in (semester.home / folder).glob("*.py")}
    files["toy.py"] += more
    record = Record(semester.home / folder)
    return look_at_brought(kit.bundle, files, None, list_manifests(), record)


def test_a_wrong_function_is_named_first_and_blocks_what_uses_it(third: Semester) -> None:
    spoil(third, "92_thrice/toy.py")
    spoil(third, "90_toy/toy.py")
    said = checked(third)
    head = "✗ your toy.weighted_sum of 90 is wrong: see 90.1.value"
    assert head in said
    assert "mend it in the folder of 90, then 'photograd course start 92 --update'" in said
    assert "your twice.double" not in said  # it is right, but for what it uses
    later = said.partition(head)[2]
    assert "· 92.1.sum" in later
    assert "blocked by 90.1.value (your toy.weighted_sum of 90): mend that first" in later
    assert "hint: of 9" not in said
    assert "✓ 92.2.plain" in later  # does not use it


def test_the_origin_beside_it_is_named_where_it_is_another(third: Semester) -> None:
    spoil(third, "92_thrice/toy.py")
    said = checked(third)
    there = f"the one in {third.home}/90_toy/toy.py is another: "
    assert f"{there}'photograd course start 92 --update' takes that" in said
    third.course("start", "92", "92_thrice", "--update")
    assert "All green." in checked(third, code=0)


def test_green_checks_do_not_hide_a_wrong_function(third: Semester) -> None:
    """What is looked at here may not show it, as 06 does not show a wrong blend of 04."""
    hidden = "    return float(np.sum(w * np.exp(-x))) + float(np.sum(x))\n"
    third.put("92_thrice/toy.py", third.text("92_thrice/toy.py").replace(DONE, hidden))
    said = checked(third)
    assert "✓ 92.1.sum" in said
    assert "your toy.weighted_sum of 90 is wrong: see 90.1.value" in said
    assert "All that is looked at here passes, but toy.weighted_sum is wrong" in said
    assert "All green" not in said


def test_one_task_looks_at_what_it_uses(third: Semester) -> None:
    spoil(third, "92_thrice/toy.py")
    assert "is wrong" not in checked(third, "--task", "plain", code=0)
    assert "is wrong: see 90.1.value" in checked(third, "--task", "treble")


def test_json_names_it(third: Semester, capsys: pytest.CaptureFixture[str]) -> None:
    spoil(third, "92_thrice/toy.py")
    capsys.readouterr()
    said = checked(third, "--json")
    result = json.JSONDecoder().raw_decode(said[said.index('{"assignment"') :])[0]
    (wrong,) = result["brought"]
    assert (wrong["function"], wrong["check"]) == ("toy.weighted_sum", "90.1.value")
    assert [each["status"] for each in result["checks"]] == ["blocked", "passed"]


def test_a_stub_and_a_file_that_is_no_python_are_said(third: Semester) -> None:
    third.put("92_thrice/toy.py", third.stub("90_toy"))
    said = checked(third)
    assert "· your toy.py of 90 is used here and lacks weighted_sum" in said
    assert "is wrong" not in said
    third.put("92_thrice/toy.py", "def weighted_sum(:\n")
    said = checked(third)
    assert "✗ your toy.py of 90 cannot be read as Python" in said


def test_own_mistakes_keep_their_hints(third: Semester) -> None:
    text = third.text("92_thrice/thrice.py").replace("1.5 *", "2.5 *")
    third.put("92_thrice/thrice.py", text)
    said = checked(third)
    assert "✗ 92.1.sum" in said
    assert "hint: of 92: multiply" in said


def test_who_uses_whom_is_read_from_the_text() -> None:
    sources = {
        "a": "TABLE = make()\ndef make(): ...\ndef f(): return TABLE\ndef g(): ...\nclass V:\n"
        "    def m(self): return g()\n",
        "b": "import a as first\nfrom a import V as W\ndef h(): return first.f()\ndef v(): "
        "return W().m()\ndef k(): return np.g()\n",
    }
    uses = Uses(sources, "b")
    assert {("a", "f"), ("a", "TABLE"), ("a", "make")} <= uses.reached(["h"])
    assert {("a", "V"), ("a", "g")} <= uses.reached(["v"])
    assert not [name for name in uses.reached(["k"]) if name[0] == "a"]
    assert uses.reached(["a.V.m"]) == {("a", "V"), ("a", "g")}
    assert ("a", "f") in uses.everything()
    assert Uses({"a": "def f(:"}, "a").everything() == frozenset()


@pytest.mark.parametrize("number", ["06", "07", "09", "12", "14", "15"])
def test_every_module_that_is_brought_has_checks_for_what_is_used(number: str) -> None:
    kit, manifests = find_kit(number), list_manifests()
    modules = (*kit.manifest.brought, kit.manifest.module)
    owners = {name: owner_of(name, manifests) for name in modules}
    files = {
        f"{name}.py": (ASSIGNMENTS / owner.folder_name / f"{name}.py").read_bytes()
        for name, owner in owners.items()
        if owner is not None
    }
    used = uses_of(kit.bundle, files).everything()
    for name in kit.manifest.brought:
        owner = owners[name]
        assert owner is not None
        functions = {function for module, function in used if module == name}
        called = {
            each.partition(".")[0] for c in find_kit(owner.id).bundle.checks for each in c.calls
        }
        assert functions & called, (number, name)


BLEND = '''
def gltf(wo, wi, base_color, metalness, roughness):
    """Blends f0, not the values: equation (20) read wrongly."""
    lobe = ggx_lobe(wo, wi, roughness)[:, None]
    cos = np.sum(wo * half_vector(wo, wi), axis=1)[:, None]
    m = metalness[:, None]
    F = schlick((1 - m) * 0.04 + m * base_color, cos)
    return (1 - m) * (1 - F) * above(wo, wi)[:, None] * base_color / np.pi + F * lobe
'''


@pytest.mark.parametrize(("number", "task"), [("06", "06.3"), ("07", "07.6")])
def test_a_wrong_material_of_04_is_named_in_later_assignments(
    tmp_path: Path, number: str, task: str
) -> None:
    kit = find_kit(number)
    modules = (*kit.manifest.brought, kit.manifest.module)
    owners = [owner_of(name, list_manifests()) for name in modules]
    files = {
        f"{owner.module}.py": (ASSIGNMENTS / owner.folder_name / f"{owner.module}.py").read_bytes()
        for owner in owners
        if owner is not None
    }
    files["reflectance.py"] += BLEND.encode()
    checks = [check for check in kit.bundle.checks if check.task == task]
    looked = look_at_brought(kit.bundle, files, checks, list_manifests(), Record(tmp_path))
    named = {(each.name, each.outcome.id) for each in looked.culprits}
    assert ("reflectance.gltf", "04.5.blend") in named
    needing = with_needs(checks, uses_of(kit.bundle, files), looked)
    assert all("reflectance.gltf" in check.needs for check in needing)
    for outcome in check_here(kit.bundle, files, needing, wrong=looked.wrong):
        assert outcome.status.value in ("passed", "blocked"), outcome
        assert not outcome.hint
