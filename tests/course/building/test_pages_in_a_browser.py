"""All pages in Chromium, at two widths: nothing is complained about, nothing sticks out.

One browser opens one page that holds every handout twice in frames, and measures them.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from html import escape
from pathlib import Path

import pytest
from photograd_course.build.page.page import handout_page
from photograd_course.build.products import complete_kit

from support.missing import missing
from support.tree import ROOT

FOLDERS = sorted(path.parent for path in (ROOT / "assignments").glob("*/handout.md"))
WIDTHS = (400, 1400)
OPTIONS = (
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
    *("--disable-extensions", "--host-resolver-rules=MAP * ~NOTFOUND", "--enable-logging=stderr"),
    *("--virtual-time-budget=20000", "--dump-dom"),
)
MEASURE = """
const results = {};
for (const frame of document.querySelectorAll("iframe")) {
  const page = frame.contentDocument, root = page.documentElement;
  const boxes = [...page.querySelectorAll(".equation")].map((each) => {
    const scroll = each.querySelector(".scroll"), math = each.querySelector("math");
    return [math.getBoundingClientRect().height, math.getBoundingClientRect().width,
            scroll.scrollWidth - scroll.clientWidth];
  });
  results[frame.name] = {
    tall: boxes.filter((box) => box[0] > 8 && box[1] > 8).length,
    cut: boxes.filter((box) => box[2] > 1).length,
    equations: boxes.length,
    wide: root.scrollWidth - root.clientWidth,
    pictures: [...page.images].filter((each) => each.complete && each.naturalWidth > 0).length,
    images: page.images.length,
    font: page.fonts.check("16px Mathematics", "\\u{1D465}"),
    fonts: [...page.fonts].map((each) => each.status),
    lost: [...page.links].filter((each) => !page.getElementById(each.hash.slice(1))).length,
  };
}
const told = document.createElement("pre");
told.id = "told";
told.textContent = JSON.stringify(results);
document.body.append(told);
"""


def browse(page: Path, profile: Path) -> tuple[dict[str, dict[str, object]], list[str]]:
    """What a page measures, by frame, and what was written to the console."""
    program = shutil.which("chromium") or missing("chromium is not installed", by_choice=True)
    command = [program, *OPTIONS, f"--user-data-dir={profile}", page.as_uri()]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=300, check=True)
    (told,) = re.findall(r'<pre id="told">(.*?)</pre>', ran.stdout, re.DOTALL)
    said = [line for line in ran.stderr.splitlines() if ":CONSOLE" in line]
    return json.loads(told.replace("&quot;", '"')), said


def in_frames(pages: dict[str, str], target: Path) -> Path:
    """A page that holds others, each at each width."""
    frames = "".join(
        f'<iframe name="{name} {width}" width="{width}" height="900" srcdoc="{escape(page)}">'
        "</iframe>"
        for name, page in pages.items()
        for width in WIDTHS
    )
    script = f'<script>addEventListener("load", () => {{ {MEASURE} }});</script>'
    target.write_text(f"<!doctype html><meta charset=utf-8>{frames}{script}", encoding="utf-8")
    return target


@pytest.mark.exhaustive
def test_pages_in_a_browser(tmp_path: Path) -> None:
    pages = {f.name: complete_kit(f)["handout.html"].decode("utf-8") for f in FOLDERS}
    told, said = browse(in_frames(pages, tmp_path / "all.html"), tmp_path / "profile")
    assert said == []
    assert len(told) == len(pages) * len(WIDTHS)
    for name, found in told.items():
        assert found["equations"] == found["tall"] > 0, name
        assert found["fonts"] == ["loaded"], name
        assert found["font"] is True, name
        assert found["wide"] == 0, name
        assert found["images"] == found["pictures"], name
        assert found["lost"] == 0, name
        if name.endswith(" 1400"):
            assert found["cut"] == 0, name


@pytest.mark.exhaustive
def test_what_is_wrong_is_seen(tmp_path: Path) -> None:
    good = handout_page("# T\n\n$$ x = y + z \\tag{1} $$\n\nSee (1).\n")
    pages = {
        "console": good.replace("</main>", '</main><script>"not of this page"</script>'),
        "wide": good.replace("</main>", '<div style="width: 9000px">wide</div></main>'),
        "lost": good.replace('id="eq-1"', ""),
        "image": good.replace("</main>", '<img src="data:image/png;base64,AA" alt="a"></main>'),
        "flat": good.replace("<math ", '<math style="display: none" '),
    }
    told, said = browse(in_frames(pages, tmp_path / "all.html"), tmp_path / "profile")
    assert said
    assert told["wide 400"]["wide"] != 0
    assert told["lost 400"]["lost"] == 1
    assert told["image 400"]["images"] != told["image 400"]["pictures"]
    assert told["flat 400"]["equations"] != told["flat 400"]["tall"]
