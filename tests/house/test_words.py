"""Names and phrases that the sources no longer use (support/words.py)."""

from __future__ import annotations

import pytest

from support import python_words
from support.tree import ROOT, cpp_texts, relative, walk
from support.words import (
    EXCEPTIONS,
    TABLE_ROW,
    banned_names,
    banned_phrases,
    cpp_names,
    cpp_prose,
    parts,
    python_prose,
)

PYTHON = ROOT / "python"
# Folders whose comments and docstrings are read.
SPOKEN = ("python", "docs", "bench", "tools", "assignments", "tests")


def python_texts() -> dict[str, str]:
    """Sources by path below python/."""
    paths = walk(PYTHON, {".py"})
    return {path.relative_to(PYTHON).as_posix(): path.read_text(encoding="utf-8") for path in paths}


def test_cpp_names_speak_the_language_of_the_field() -> None:
    texts = cpp_texts()
    assert len(texts) > 300, "the sources are not found any more"
    assert banned_names(texts) == []


def test_exceptions_are_still_needed() -> None:
    texts = cpp_texts()
    names = {path: {name for _, name in cpp_names(path, texts[path])} for path, _ in EXCEPTIONS}
    assert [key for key in EXCEPTIONS if key[1] not in names[key[0]]] == []


def test_cpp_prose_speaks_the_language_of_the_field() -> None:
    found = [
        line
        for path, text in cpp_texts().items()
        for line in banned_phrases(f"cpp/{path}", cpp_prose(text))
    ]
    assert found == []


def test_python_names_speak_the_language_of_the_field() -> None:
    texts = python_texts()
    assert len(texts) > 300, "the sources are not found any more"
    assert [line for path, text in texts.items() for line in python_words.banned(path, text)] == []


def test_exceptions_of_python_are_still_needed() -> None:
    texts = python_texts()
    for path, name in python_words.EXCEPTIONS:
        assert name in {found for _, found in python_words.names_of(path, texts[path])}, path


def test_python_prose_speaks_the_language_of_the_field() -> None:
    sources = [path for folder in SPOKEN for path in walk(ROOT / folder, {".py"})]
    assert len(sources) > 300
    found = [
        line
        for path in sources
        for line in banned_phrases(relative(path), python_prose(path.read_text(encoding="utf-8")))
    ]
    assert found == []


def course_texts() -> dict[str, str]:
    """Handouts, questions, diagnoses, hints and manifests of all assignments, by path."""
    paths = walk(ROOT / "assignments", {".md", ".toml", ".json"})
    return {relative(path): TABLE_ROW.sub("", path.read_text(encoding="utf-8")) for path in paths}


def test_texts_of_the_course_speak_the_language_of_the_field() -> None:
    texts = course_texts()
    assert len(texts) > 60, "the assignments are not found any more"
    assert [line for path, text in texts.items() for line in banned_phrases(path, text)] == []


def test_pages_speak_the_language_of_the_field() -> None:
    pages = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *walk(ROOT / "docs", {".md"})]
    found = [
        line
        for path in pages
        for line in banned_phrases(
            relative(path), TABLE_ROW.sub("", path.read_text(encoding="utf-8"))
        )
    ]
    assert found == []


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("photograd/render/path/x.h", "struct VeilList {};"),
        ("photograd/render/path/x.h", "void d_veils_backward();"),
        ("photograd/render/path/x.cpp", "if (material.sheer) f();"),
        ("photograd/scene/x.h", "int find_light();"),
        ("photograd/light/light_map.h", "int seen_by;"),
        ("photograd/render/light/light_map.h", ""),  # the name of the file
        ("photograd/splat/x.h", "int least = 0;"),
        ("bindings/bind_x.cpp", 'm.def("trace_veils", &f);'),  # the name in Python
        ("photograd/core/x.h", "std::size_t place = 0;"),
    ],
)
def test_a_planted_old_name_is_seen(path: str, text: str) -> None:
    assert len(banned_names({path: text})) == 1


def test_other_meanings_and_prose_are_free() -> None:
    texts = {
        "photograd/medium/x.h": "// drawn and seen\nint haircut; int placement, unseen;",
        "photograd/grid/x.h": 'int pieces, most, halves; const char* t = "place"; int n = 1\'000;',
        "photograd/ops/thin_film.h": "struct Wave {};",
    }
    assert banned_names(texts) == []
    assert parts("d_LightMap2RGB") == ("d", "light", "map", "2", "rgb")


@pytest.mark.parametrize(
    "text",
    [
        "// The derivative by x.",
        "/// Gradients\n/// by the radius.",
        "int x;  // Sums on the way\n        // back.",
        'fail("a body of signed distances that shines");',
        "/* lights asked */",
        "// in metres",
    ],
)
def test_a_planted_phrase_is_seen(text: str) -> None:
    assert len(banned_phrases("x.h", cpp_prose(text))) == 1


@pytest.mark.parametrize(
    "text",
    ['"""The slope by x."""', "x = 1  # in metres", 'def f():\n    """Of whoever\n    asks."""\n'],
)
def test_a_planted_phrase_of_python_is_seen(text: str) -> None:
    assert len(banned_phrases("x.py", python_prose(text))) == 1


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("photograd/x.py", "class Unknown: ..."),
        ("photograd/transport/shapes.py", "places = ()"),
        ("photograd/fields/x.py", "self.seen_by = 1"),
        ("photograd/splats/x.py", "def f(*, least): ..."),
        ("photograd_course/src/photograd_course/build/dossier.py", ""),
        ("photograd_course/src/photograd_course/build/rules/x.py", "def look(build): ..."),
    ],
)
def test_a_planted_old_name_of_python_is_seen(path: str, text: str) -> None:
    assert len(python_words.banned(path, text)) == 1


def test_other_names_of_python_are_free() -> None:
    text = "# places, an Unknown\nclass RecoveryOptions: ...\nf(unknown, placement, look_at)\n"
    assert python_words.banned("photograd/transport/x.py", text) == []
    assert python_words.banned("photograd_course/src/photograd_course/x.py", "seen = look()") == []


def test_prose_bans_leave_names_in_python_alone() -> None:
    text = 'lamp = {"lamp": 1}  # a light\nprint("colour")\n'
    assert banned_phrases("x.py", python_prose(text)) == []


def test_phrases_of_other_meanings_pass() -> None:
    text = "// Checked: derivatives by finite differences. A lampshade.\nint lamp, derivative, by;"
    assert banned_phrases("x.h", cpp_prose(text)) == []
