"""Every rule that reads goes red on a copy that breaks it, and only then."""

from __future__ import annotations

from pathlib import Path

import pytest
from photograd_course.build.course_files import build_of
from photograd_course.build.leak_words import says_something, shingles_of
from photograd_course.build.rules import READING

from .support import TOY, Broken


@pytest.mark.parametrize("rule", list(READING))
def test_the_scaffold_and_the_toy_keep_the_rule(rule: str, scaffold: Path) -> None:
    for folder in (scaffold, TOY):
        assert list(READING[rule](build_of(folder))) == []


def test_markers(broken: Broken) -> None:
    broken.change("light.py", "# <<< solution", "# <<< student")
    assert broken.broken_rules() == {"markers"}


def test_markers_of_unknown_tasks(broken: Broken) -> None:
    broken.change("light.py", "solution 17.1", "solution 17.2")
    assert broken.says("markers") == [
        "light.py marks a solution of 17.2, which is no task of the manifest",
        "light.py marks no solution of task 17.1",
    ]


def test_compiles(broken: Broken) -> None:
    stub = "# <<< solution\n    # >>> student\n    # return = 1\n    # <<< student"
    broken.change("light.py", "# <<< solution", stub)
    assert "kit/light.py, line 13: the stripped file does not compile" in broken.says("compiles")[0]


def test_imports(broken: Broken) -> None:
    broken.change("light.py", "def twice", "import statistics\n\n\ndef twice")
    wanted = "imports statistics, which assignment.toml does not list"
    assert f"the starter {wanted}" in broken.says("imports")
    assert f"the solution {wanted}" in broken.says("imports")


@pytest.mark.parametrize(
    ("new", "said"),
    [
        ("# >>> solution 17.1\ndef other(x):\n    return x\n# <<< solution\ndef twice", "other is"),
        ("# >>> solution 17.1\nLIMIT = 3\n# <<< solution\ndef twice", "LIMIT is public"),
    ],
)
def test_faces(broken: Broken, new: str, said: str) -> None:
    broken.change("light.py", "def twice", new)
    assert said in broken.says("faces")[0]


def test_faces_of_docstrings_and_signatures(broken: Broken) -> None:
    text = (broken.folder / "light.py").read_text("utf-8")
    head, body = text.split("def twice")
    whole = body.replace("    # >>> solution 17.1\n", "").replace("    # <<< solution\n", "")
    stub = 'def twice(x, y):\n    """Other."""\n'.splitlines()
    block = "".join(f"# {line}\n" for line in stub)
    broken.add(
        "light.py",
        f"{head}# >>> solution 17.1\ndef twice{whole}\n\n# <<< solution\n"
        f"# >>> student\n{block}# <<< student\n",
    )
    assert broken.says("faces") == ["twice has another signature in the starter"]
    broken.change("light.py", "# def twice(x, y):", "# def twice(x: np.ndarray) -> np.ndarray:")
    assert broken.says("faces") == ["twice has another docstring in the starter"]


def test_faces_of_functions_that_the_manifest_names(broken: Broken) -> None:
    broken.change("assignment.toml", '["twice"]', '["twice", "thrice"]')
    assert broken.says("faces") == ["task 17.1 names thrice, which the module does not define"]


def test_points(broken: Broken) -> None:
    broken.change("checks/hidden/task_1.py", "points=35", "points=34")
    broken.change("questions.toml", "points = 20", "points = 21")
    assert [text.partition(":")[0] for text in broken.says("points")] == ["code", "questions"]


def test_prerequisites(broken: Broken) -> None:
    broken.change("assignment.toml", "prerequisites = []", 'prerequisites = ["16", "17"]')
    assert broken.says("prerequisites") == [
        "prerequisite 16 does not exist",
        "prerequisite 17 does not come before 17",
    ]


def test_counts(broken: Broken) -> None:
    (broken.folder / "alternatives" / "vectorized.py").unlink()
    broken.change("assignment.toml", '["twice"]', '["twice_backward"]')
    said = broken.says("counts")
    assert "the adjoint twice_backward and 2 named mutants; it needs 5" in said[0]
    assert said[1] == "there are 2 alternatives; it needs 3"


def test_figures(broken: Broken) -> None:
    broken.change("handout.md", "Write", "![](figures/fig1_x.png) Write")
    assert broken.says("figures") == [
        "the handout shows figures/fig1_x.png, which is not in the kit"
    ]
    broken.add("figures/fig1_x.png", "x" * 500_001)
    assert "more than 500000" in broken.says("figures")[0]


def solve_with_names(broken: Broken) -> None:
    broken.change("light.py", "return 2.0 * x", "glimmer = 2.0 * x\n    return glimmer")


@pytest.mark.parametrize(
    ("path", "old", "new"),
    [
        ("handout.md", "Write", "The glimmer. Write"),
        ("checks/task_1.py", "1, 2 and 5", "glimmer 1, 2 and 5"),
        ("questions.toml", "What becomes", "What glimmer becomes"),
        ("explore.py", "# Play", "# glimmer Play"),
    ],
)
def test_leaked_names(broken: Broken, path: str, old: str, new: str) -> None:
    solve_with_names(broken)
    assert broken.says("leaked names") == []
    broken.change(path, old, new)
    assert "'glimmer' belongs to the solution and occurs in" in broken.says("leaked names")[0]
    broken.change("assignment.toml", "vocabulary = []", 'vocabulary = ["glimmer"]')
    assert broken.says("leaked names") == []


def test_a_hidden_check_that_is_named_in_the_kit(broken: Broken) -> None:
    assert broken.says("leaked names") == []
    broken.change("handout.md", "Write", "(17.1.random) Write")
    assert broken.says("leaked names") == [
        "the hidden check '17.1.random' is named in kit/README.md"
    ]


def test_leaked_names_in_the_wheel(broken: Broken) -> None:
    broken.change("light.py", "return 2.0 * x", "require_cheap = 2.0 * x\n    return require_cheap")
    said = broken.says("leaked names")
    assert (
        "'require_cheap' belongs to the solution and occurs in wheel/photograd_course/" in said[0]
    )


def test_leaked_names_in_another_kit(broken: Broken) -> None:
    solve_with_names(broken)
    other = broken.folder.with_name("18_other")
    other.mkdir()
    for path, text in {
        "assignment.toml": (broken.folder / "assignment.toml").read_text("utf-8"),
        "light.py": "def twice(x): pass  # glimmer\n",
    }.items():
        (other / path).write_text(text, "utf-8")
    assert "kits/18_other/kit/light.py" in broken.says("leaked names")[0]


def test_leaked_shingles(broken: Broken) -> None:
    line = "step = gain * slope + offset"
    broken.change("light.py", "return 2.0 * x", f"{line}\n    return 2.0 * x")
    assert broken.says("leaked shingles") == []
    broken.add("adapters.py", "def f(gain, slope, offset):\n    return gain * slope + offset\n")
    said = broken.says("leaked shingles")
    assert said == [
        f"'gain * slope + offset' of the solution stands in {place}/adapters.py"
        for place in ("kit", "public")
    ]
    # What the handout gives in a fence, students may have.
    broken.change("handout.md", "Write", f"```python\n{line}\n```\n\nWrite")
    assert broken.says("leaked shingles") == []


def test_the_names_of_annotated_arguments_are_given(broken: Broken) -> None:
    head = "def twice(x: np.ndarray, gain: float = 2.0, offset: float = 0.0) -> np.ndarray:"
    broken.change("light.py", "def twice(x: np.ndarray) -> np.ndarray:", head)
    broken.change("light.py", "return 2.0 * x", "return twice(x, gain, offset) if gain else x")
    broken.add("adapters.py", "def f(twice, x, gain, offset):\n    return twice(x, gain, offset)\n")
    assert broken.says("leaked shingles") == []


def test_comments_and_docstrings_are_no_shingles() -> None:
    text = 'def f(a):\n    """a b c d e f g"""\n    # a b c d e f g\n    return a  # b c d\n'
    words = {word for each in shingles_of(text) for word in each}
    assert words == {"def", "f", "(", "a", ")", ":", "return"}


def test_what_shingles_tell() -> None:
    assert says_something(("gain", "*", "slope", "+", "offset"))
    assert not says_something(("np", ".", "exp", "(", "x"))
    assert not says_something(("for", "i", "in", "range", "("))
    assert says_something(("i", ",", "j", ",", "gain"))
    assert not says_something(("i", ",", "j", ",", "k"))
    assert not says_something(("linalg", ".", "norm", "(", "x"))


def test_likeness(broken: Broken) -> None:
    assert broken.says("likeness") == []
    broken.change("alternatives/vectorized.py", "def twice(x):", "def twice(values):")
    broken.change("alternatives/vectorized.py", "return x + x", "return 2.0 * values")
    said = ["twice of the alternative vectorized is the solution's"]
    assert broken.says("likeness") == said
