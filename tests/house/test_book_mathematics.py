"""Formulas of the book are MathML and need no network."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from support.missing import need_module
from support.tree import ROOT

SETTINGS = f"""
import sys
sys.path.insert(0, {str(ROOT / "docs")!r})
import mathematics
extensions = ["myst_parser"]
myst_enable_extensions = ["dollarmath"]
html_math_renderer = "mathml"
setup = mathematics.register
"""
PAGE = """# A page

The angle of w_o is $\\theta$, and `w_o` is code.

$$ f = \\frac{1}{2} \\tag{3} $$
"""


def test_formulas_are_mathml(tmp_path: Path) -> None:
    need_module("sphinx", by_choice=True)
    need_module("myst_parser", by_choice=True)
    (tmp_path / "handouts").mkdir()
    (tmp_path / "conf.py").write_text(SETTINGS, "utf-8")
    (tmp_path / "index.md").write_text(f"{PAGE}\n```{{toctree}}\nhandouts/01\n```\n", "utf-8")
    (tmp_path / "handouts" / "01.md").write_text(PAGE, "utf-8")
    out = tmp_path / "out"
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "-b", "html", str(tmp_path), str(out)]
    subprocess.run(command, check=True, capture_output=True)
    handout = (out / "handouts" / "01.html").read_text("utf-8")
    index = (out / "index.html").read_text("utf-8")
    for page in (handout, index):
        assert page.count('display="block"') == page.count("<span>(3)</span>") == 1
        assert page.count('display="inline"') == 1
        assert "\\frac" not in page
        assert 'src="http' not in page
    assert "<msub><mi>w</mi><mi>o</mi></msub>" in handout
    assert "w_o</span></code>" in handout  # of code
    assert "<msub>" not in index
    assert "Mathematics" in (out / "_static" / "mathematics.css").read_text("utf-8")
