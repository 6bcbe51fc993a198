"""What leaves the instructor's folder: files of the kit, and files of the public checks.

Pure functions of a source folder, also called while a wheel is built, so only the standard library
(and tomli on Python 3.10) is needed here, and for pages what the extra `handouts` names.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..assignment.brought import brought_sources
from ..assignment.check_files import public_check_files
from ..assignment.manifest import Manifest, read_manifest
from ..assignment.toml import read_toml
from .notebook import notebook_of
from .page.page import handout_page
from .regions import strip_solution
from .toml_text import tables, toml_key

SECRET_KEYS = ("answer", "because", "where")  # of questions
GLOSSARY = "glossary.toml"  # of the course, beside the assignments
PAGE = "handout.html"  # of the kit: README.md as a page
COPIED = ("figures/*.png", "data/*")  # into the kit as they are


def kit_files(folder: Path) -> dict[str, bytes]:
    """The student's folder: path to content.

    Args:
        folder: an assignment's source folder.

    Returns:
        The stub module, stubs of earlier modules that students bring along, README.md (the
        handout) with figures/ and data/, answers.toml to fill in, explore.py with its notebook,
        adapters.py; each only where the source has it.

    Raises:
        IoError, SceneError: the manifest, a question or a marker is wrong.
    """
    manifest = read_manifest(folder)
    module = f"{manifest.module}.py"
    files = {module: _encode(strip_solution(_text(folder / module), module))}
    for name, text in brought_sources(folder, manifest).items():
        files[f"{name}.py"] = _encode(strip_solution(text, f"{name}.py"))
    if "answers.toml" in manifest.submission:
        files["answers.toml"] = _encode(answers_template(manifest))
    if (folder / "handout.md").exists():
        files["README.md"] = _encode(readme(manifest, _text(folder / "handout.md")))
    if (folder / "explore.py").exists():
        script = _text(folder / "explore.py")
        files["explore.py"] = _encode(script)
        graded = [f"{name}.py" for name in (manifest.module, *manifest.brought)]
        files["explore.ipynb"] = _encode(notebook_of(script, graded))
    if (folder / "adapters.py").exists():
        files["adapters.py"] = _encode(_text(folder / "adapters.py"))
    for pattern in COPIED:
        for path in sorted(p for p in folder.glob(pattern) if p.is_file()):
            files[path.relative_to(folder).as_posix()] = path.read_bytes()
    return dict(sorted(files.items()))


def public_files(folder: Path) -> dict[str, bytes]:
    """The public checks: manifest, checks without hidden ones, questions without keys, hints.

    Raises:
        IoError, SceneError: the manifest, a question or a marker is wrong.
    """
    files = {"assignment.toml": _encode(_text(folder / "assignment.toml"))}
    files |= {path: _encode(text) for path, text in public_check_files(folder).items()}
    if (folder / "questions.toml").exists():
        files["questions.toml"] = _encode(questions_without_keys(folder))
    for name in ("adapters.py", "hints.json"):
        if (folder / name).exists():
            files[name] = _encode(_text(folder / name))
    return dict(sorted(files.items()))


def readme(manifest: Manifest, handout: str) -> str:
    """The handout, with how to work on it below its title, where it has questions."""
    if not (manifest.folder / "questions.toml").exists():
        return handout
    title, _, rest = handout.partition("\n")
    number = manifest.id
    work = f"""
> **How to work.** In this folder, `photograd course predict {number}` comes before anything
> else. Then `photograd course check {number}` as often as you like, `--task` for one task: it
> says what is wrong and draws what helps. When the code is final, look at the questions with
> `photograd course questions {number}`; answers and your name go into `answers.toml`, numbers
> to four significant digits. `photograd course submit {number}` packs the archive to hand in.
> Green is not finished: some checks run only after you have handed in. `explore.py`, or the
> notebook `explore.ipynb`, is for play, and makes Figure 1 with your functions.
>
> **A derivative is written, not computed.** No complex steps, dual numbers, finite differences,
> fits or contour integrals of shifted evaluations, nor code made from text, in a function that
> returns a derivative and in what it calls. The grader looks at the source and at what the function
> does when it runs; a derivative that costs many forward calls earns none of its task's points.
> Allowed: your own tape of assignment 02, stored paths, the forward function again at the same
> inputs, and finite differences in a test of your own that no graded function calls.
>
> **Every function** leaves its arguments as they are, reads arrays of any memory layout (read-only
> ones and views too), and gives equal answers to equal calls. A row alone gets what it gets
> among others, up to rounding. Hidden checks ask for all this.
"""
    return f"{title}\n{work}{rest}"


def wheel_kits(folder: Path, *, pages: bool = False) -> dict[str, bytes]:
    """Both products as they lie in a wheel's `kits/NN_name/`: kit/ and public/.

    Args:
        folder: an assignment's source folder.
        pages: with the handout as a page, whose figures are those beside it.
    """
    files = kit_files(folder)
    if pages and "README.md" in files:
        files[PAGE] = _encode(handout_page(files["README.md"].decode(), glossary(folder.parent)))
    kit = {f"kit/{path}": data for path, data in sorted(files.items())}
    return {**kit, **{f"public/{path}": data for path, data in public_files(folder).items()}}


def glossary(root: Path) -> dict[str, str]:
    """Words of the course and the sentence that explains each."""
    path = root / GLOSSARY
    return {k: str(v) for k, v in read_toml(path)["words"].items()} if path.exists() else {}


def questions_without_keys(folder: Path) -> str:
    """`questions.toml` as students have it."""
    parts = [
        tables(kind, [{k: v for k, v in entry.items() if k not in SECRET_KEYS} for entry in found])
        for kind, found in read_toml(folder / "questions.toml").items()
    ]
    return "\n".join(parts)


def answers_template(manifest: Manifest) -> str:
    """`answers.toml` with an empty answer for each question.

    Raises:
        SceneError: a question lacks its id.
    """
    lines = ['student = ""  # your name or number, as your course knows it', "", "[answers]"]
    for kind, entry in _questions(manifest.folder):
        options = entry.get("options", [])
        last = "abcdefgh"[len(options) - 1 : len(options)]
        form = f"a letter, a to {last}" if options else "a number such as 0.1250"
        lines.append(f'{toml_key(str(entry["id"]))} = ""  # {kind}: {form}')
    return "\n".join(lines) + "\n"


def _questions(folder: Path) -> list[tuple[str, dict[str, Any]]]:
    path = folder / "questions.toml"
    if not path.exists():
        return []
    return [(kind, entry) for kind, found in read_toml(path).items() for entry in found]


def _text(path: Path) -> str:
    """A text file; line ends of any system become plain newlines."""
    return path.read_text(encoding="utf-8")


def _encode(text: str) -> bytes:
    return text.encode("utf-8")
