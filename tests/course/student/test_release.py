"""What a course hands out, taken from dist/ alone: it works, and gives nothing away."""

from __future__ import annotations

import ast
import functools
import io
import itertools
import json
import re
import shutil
import subprocess
import zipfile
from pathlib import Path

import pytest
from photograd_course.assignment.check_files import check_files, public_check_files
from photograd_course.assignment.manifest import read_manifest
from photograd_course.assignment.toml import read_toml
from photograd_course.build.regions import solution_parts, strip_solution
from tools.release import release

from course.student.laptop import Laptop, build_wheel, laptop_with, link
from support.missing import missing
from support.tree import ROOT

FOLDERS = sorted(path.parent for path in (ROOT / "assignments").glob("*/assignment.toml"))
TEXTS = (".py", ".md", ".toml", ".json", ".ipynb", ".html", ".txt", ".css", ".js")
TELLING = 40  # characters of two lines that follow one another by no coincidence
# A gray box of no density: explore.py of 09 starts from it as the solution does.
FREE = {"grid = np.full((n, n, n, 4), 0.5) grid[..., 3] = 0.0"}
SECRET_FILES = ("mutants.toml", "answers.py", "solution.md", "equivalent.toml", "hidden/")
# Named like a graded function: the project's own metric and optimizers, with other arguments and
# ways to state them, and what encodes messages. Each is of a few lines that any book has.
TWINS = {
    *(("metrics.py", "psnr"), ("optim/adam.py", "Adam"), ("optim/momentum.py", "Momentum")),
    ("worker/codec.py", "encode"),
}


@pytest.fixture(scope="module")
def dist(tmp_path_factory: pytest.TempPathFactory) -> Path:
    target = tmp_path_factory.mktemp("release") / "dist"
    build_wheel(target)
    release(target)
    return target


@pytest.fixture(scope="module")
def laptop(dist: Path, tmp_path_factory: pytest.TempPathFactory) -> Laptop:
    (wheel,) = dist.glob("photograd_course-*.whl")
    return laptop_with(wheel, tmp_path_factory.mktemp("laptop"))


def texts_in(dist: Path) -> dict[str, str]:
    """Every text, in archives too, by place."""
    found = {}
    for path in sorted(path for path in dist.rglob("*") if path.is_file()):
        place = path.relative_to(dist).as_posix()
        if path.suffix in {".zip", ".whl"}:
            with zipfile.ZipFile(io.BytesIO(path.read_bytes())) as archive:
                for name in archive.namelist():
                    if name.endswith(TEXTS):
                        found[f"{place}/{name}"] = archive.read(name).decode("utf-8")
        elif path.suffix in TEXTS:
            found[place] = path.read_text(encoding="utf-8")
    return found


def lines_of(text: str) -> set[str]:
    """Each two lines that follow one another, or the one line that there is."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    pairs = {f"{first} {then}" for first, then in itertools.pairwise(lines)}
    return {pair for pair in pairs or lines if len(pair) >= TELLING}


@functools.cache
def secrets(folder: Path) -> set[str]:
    """Lines that only staff may read: of the solution, of hidden checks, of keys to questions."""
    manifest = read_manifest(folder)
    file = f"{manifest.module}.py"
    source = (folder / file).read_text(encoding="utf-8")
    found = {line for part in solution_parts(source, file) for line in lines_of(part.text)}
    checks, public = check_files(folder), public_check_files(folder)
    hidden = {line for path in checks if path not in public for line in lines_of(checks[path])}
    found |= hidden - {line for text in public.values() for line in lines_of(text)}
    if (folder / "answers.py").exists():
        found |= lines_of((folder / "answers.py").read_text(encoding="utf-8"))
    return {line for line in found if not line.startswith(("import ", "from ", '"""'))}


@functools.cache
def given(folder: Path) -> set[str]:
    """Lines of the starter and the handout, and lines that say the same in any course."""
    manifest = read_manifest(folder)
    file = f"{manifest.module}.py"
    starter = strip_solution((folder / file).read_text(encoding="utf-8"), file)
    handout = folder / "handout.md"
    return lines_of(starter) | (lines_of(handout.read_text("utf-8")) if handout.exists() else set())


def leaks(texts: dict[str, str]) -> list[str]:
    """Secret lines, and files that hold secrets."""
    seen = {line for text in texts.values() for line in lines_of(text)}
    found = [f"{f.name}: {line}" for f in FOLDERS for line in (secrets(f) - given(f) - FREE) & seen]
    kits = [place for place in texts if "kits/" in place]
    return found + [place for place in kits if any(name in place for name in SECRET_FILES)]


def test_everything_is_there_and_listed(dist: Path) -> None:
    names = {path.relative_to(dist).as_posix() for path in dist.rglob("*") if path.is_file()}
    kits = {f"kits/{folder.name}.zip" for folder in FOLDERS}
    pages = {f"site/handouts-read/{f.name}.html" for f in FOLDERS if (f / "handout.md").exists()}
    (wheel,) = dist.glob("*.whl")
    rest = {wheel.name, "START.md", "SHA256SUMS", "site/handouts-read/index.html"}
    assert names == kits | pages | rest
    subprocess.run(["sha256sum", "--strict", "-c", "SHA256SUMS"], cwd=dist, check=True)
    assert wheel.name in (dist / "START.md").read_text("utf-8")
    index = (dist / "site" / "handouts-read" / "index.html").read_text("utf-8")
    links = set(re.findall(r'href="([\w.]+\.html)"', index))
    assert {f"site/handouts-read/{link}" for link in links} == pages


def test_nothing_is_given_away(dist: Path) -> None:
    texts = texts_in(dist)
    assert len(texts) > 20 * len(FOLDERS)
    assert leaks(texts) == []
    for place, text in texts.items():
        if place.endswith("questions.toml"):
            assert not re.search(r"^(?:answer|because)\s*=", text, re.MULTILINE), place
    because = [
        entry["because"]
        for folder in FOLDERS
        if (folder / "questions.toml").exists()
        for entries in read_toml(folder / "questions.toml").values()
        for entry in entries
        if "because" in entry
    ]
    assert len(because) > 20
    everything = "\n".join(texts.values())
    assert [said for said in because if said in everything] == []


@pytest.mark.parametrize("folder", FOLDERS[:2], ids=lambda folder: folder.name)
def test_a_leak_would_be_seen(folder: Path) -> None:
    source = folder / f"{read_manifest(folder).module}.py"
    (part, *_) = solution_parts(source.read_text("utf-8"), source.name)
    assert leaks({"kits/a.py": part.text}) != []
    assert leaks({"kits/a.py": strip_solution(source.read_text("utf-8"), source.name)}) == []
    assert leaks({"kits/checks/hidden/task_1.py": ""}) != []
    hidden = sorted((folder / "checks" / "hidden").glob("task_*.py"))
    assert not hidden or leaks({"kits/a.py": hidden[0].read_text("utf-8")}) != []


def test_the_wheel_has_no_twin_of_a_graded_function(dist: Path) -> None:
    tasks = [task for folder in FOLDERS for task in read_manifest(folder).tasks]
    graded = {name.lower() for task in tasks for name in task.functions if "." not in name}
    found = set()
    for place, text in texts_in(dist).items():
        inside = place.partition(".whl/photograd_course/")[2]
        if inside.endswith(".py") and not inside.startswith("kits/"):
            kinds = (ast.FunctionDef, ast.ClassDef)
            names = {node.name for node in ast.walk(ast.parse(text)) if isinstance(node, kinds)}
            found |= {(inside, name) for name in names if name.lower() in graded}
    assert found == TWINS


def test_from_an_archive_to_a_submission(dist: Path, laptop: Laptop, tmp_path: Path) -> None:
    with zipfile.ZipFile(dist / "kits" / "00_setup.zip") as archive:
        archive.extractall(tmp_path)
    work = tmp_path / "00_setup"
    read = laptop.run("course", "read", "00", cwd=work)
    assert read.returncode == 0, read.stderr
    assert Path(read.stdout.strip()) == work / "handout.html"
    module = work / "first_gradient.py"
    text = module.read_text("utf-8")
    (line,) = [each for each in text.splitlines() if "raise NotImplementedError" in each]
    module.write_text(text.replace(line, "    return 2.0 * (picture - photograph) / picture.size"))
    green = laptop.run("course", "check", "00", "--json", cwd=work)
    assert green.returncode == 0, green.stderr
    assert json.loads(green.stdout.splitlines()[-1])["score"] == 1.5
    assert laptop.run("course", "submit", "00", cwd=work).returncode == 0


@pytest.mark.exhaustive
def test_the_wheel_of_the_core_gives_nothing_away_and_runs(tmp_path: Path) -> None:
    """Of `./run release`, which `./run test --all` runs before."""
    wheels = sorted((ROOT / "dist").glob("photograd-*.whl"))
    if not wheels:
        missing("dist/ has no wheel of the core: ./run release makes one", by_choice=True)
    alone = tmp_path / "dist"
    alone.mkdir()
    for wheel in (ROOT / "dist").glob("*.whl"):
        shutil.copy(wheel, alone)
    assert leaks(texts_in(alone)) == []
    (course,) = alone.glob("photograd_course-*.whl")
    laptop = laptop_with(course, tmp_path)
    site = next((tmp_path / "env").glob("lib/python3*/site-packages"))
    (site / "sitecustomize.py").unlink()  # this laptop may use what POSIX has
    with zipfile.ZipFile(wheels[-1]) as archive:
        archive.extractall(site)
    for name in ("OpenEXR", "zstandard"):
        link(name, site)
    ran = laptop.run("trace", "cornell-box", "--spp", "1", "--size", "16", cwd=tmp_path)
    assert ran.returncode == 0, ran.stderr
