"""The book: every page is reached, its first one is a picture and three doors.

That it is built without a warning, `./run docs` proves; here is what needs no Sphinx, and, under
`--all`, what a browser says about the built book.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from PIL import Image

from support.missing import missing
from support.tree import ROOT

DOCS = ROOT / "docs"
TREE = re.compile(r"^```\{toctree\}\n(.*?)^```$", re.MULTILINE | re.DOTALL)
BUILT = ROOT / "build" / "docs"
OPTIONS = (
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
    *("--disable-extensions", "--host-resolver-rules=MAP * ~NOTFOUND", "--enable-logging=stderr"),
    *("--allow-file-access-from-files", "--virtual-time-budget=20000", "--dump-dom"),
)


def listed(page: Path) -> set[Path]:
    """The pages that the tables of contents of a page name."""
    found = set()
    for body in TREE.findall(page.read_text(encoding="utf-8")):
        glob = ":glob:" in body
        for line in body.splitlines():
            if line and not line.startswith(":"):
                names = page.parent.glob(f"{line}.md") if glob else [page.parent / f"{line}.md"]
                found |= {name.resolve() for name in names}
    return found


def reached() -> set[Path]:
    """All pages below the first one."""
    waiting, found = [DOCS / "index.md"], set()
    while waiting:
        page = waiting.pop()
        if page not in found and page.is_file():
            found.add(page)
            waiting += listed(page)
    return found


def test_every_page_is_reached_from_the_first() -> None:
    pages = {path.resolve() for path in DOCS.rglob("*.md") if path.name != "README.md"}
    assert sorted(pages - reached()) == []
    for name in ("gallery", "conventions", "commands/fit", "results", "bench"):
        assert (DOCS / f"{name}.md").resolve() in reached()
    assert re.search(r"^api/index$", (DOCS / "index.md").read_text("utf-8"), re.MULTILINE)


def test_the_first_page_is_a_picture_and_three_doors() -> None:
    text = (DOCS / "index.md").read_text(encoding="utf-8")
    head, _, rest = text.partition("````{container} doors")
    assert len(re.findall(r"^!\[.+\]\(images/\S+\)$", head, re.MULTILINE)) == 1
    doors = re.findall(r"^```\{container\} door\n\*\*(.+?)\*\*", rest, re.MULTILINE)
    assert doors == ["You are a student", "You teach", "You have photographs"]
    assert "README.md" not in text
    assert all((DOCS / name).is_file() for name in re.findall(r"\]\((\S+?\.md)\)", text))


def test_pictures_are_not_too_large() -> None:
    large = {
        path.name: path.stat().st_size
        for path in (DOCS / "images").rglob("*")
        if path.suffix in {".png", ".jpg"} and path.stat().st_size > 1_500_000
    }
    assert large == {}


def test_rendered_pictures_are_those_on_record() -> None:
    record = tomllib.loads((DOCS / "images" / "heroes.toml").read_text(encoding="utf-8"))
    sizes = {}
    for path in (DOCS / "images").glob("hero_*.jpg"):
        with Image.open(path) as picture:
            sizes[path.stem.removeprefix("hero_")] = picture.size
    assert sizes == {name: (each["width"], each["height"]) for name, each in record.items()}
    page = (DOCS / "pictures.md").read_text(encoding="utf-8")
    assert set(re.findall(r"\(images/hero_(\w+)\.jpg\)", page)) == set(record)


def built() -> Path:
    if not (BUILT / "index.html").is_file():
        missing("the book is not built (./run docs)", by_choice=True)
    return BUILT


def browse(address: str, profile: Path) -> tuple[str, list[str]]:
    """What a page is in the end, and what was written to the console."""
    program = shutil.which("chromium") or missing("chromium is not installed", by_choice=True)
    command = [program, *OPTIONS, f"--user-data-dir={profile}", address]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=300, check=True)
    return ran.stdout, [line for line in ran.stderr.splitlines() if ":CONSOLE" in line]


@pytest.mark.exhaustive
@pytest.mark.parametrize("page", ["index", "conventions", "handouts/08_volume_rendering", "fit"])
def test_pages_open_without_a_network(page: str, tmp_path: Path) -> None:
    name = f"commands/{page}" if page == "fit" else page
    shown, said = browse((built() / f"{name}.html").as_uri(), tmp_path)
    assert said == []
    assert "<h1>" in shown
    fetched = re.findall(r'(?:src|href)="(https?://[^"]+\.(?:js|css|woff2?|png))"', shown)
    assert fetched == []


@pytest.mark.exhaustive
def test_it_is_searched_without_a_network(tmp_path: Path) -> None:
    address = (built() / "search.html").as_uri()
    shown, said = browse(f"{address}?q=visible+normals", tmp_path)
    assert said == []
    _, _, results = shown.partition('id="search-results"')
    found = re.findall(r'<a href="([^"#]+\.html)[^"]*" data-score', results)
    assert "handouts/04_reflectance.html" in found
    assert [page for page in found if not (BUILT / page).is_file()] == []


def test_settings_of_the_book_ask_for_nothing_from_elsewhere() -> None:
    code = "import json, conf; print(json.dumps([conf.html_static_path, conf.html_css_files, "
    code += "conf.html_show_search_summary]))"
    if shutil.which("sphinx-build", path=str(Path(sys.executable).parent)) is None:
        missing("sphinx is not installed", by_choice=True)
    ran = subprocess.run(
        [sys.executable, "-c", code], cwd=DOCS, capture_output=True, text=True, check=True
    )
    static, styles, summaries = json.loads(ran.stdout)
    assert all((DOCS / path).exists() for path in static)
    assert styles == ["book.css"]
    assert summaries is False  # they would be fetched, which no browser does for a file
