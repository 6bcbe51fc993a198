"""Handouts as pages: formulas are rendered, links lead somewhere, everything is inside."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from photograd_course.build.page.letters import typeset
from photograd_course.build.page.mathematics import split_pieces, split_tag, to_mathml
from photograd_course.build.page.page import handout_page, with_figures
from photograd_course.build.products import complete_kit
from photograd_course.build.public import glossary
from photograd_course.errors import SceneError

from support.tree import ROOT

from .pages import faults, look_at

FOLDERS = sorted(path.parent for path in (ROOT / "assignments").glob("*/handout.md"))
PAGE = ROOT / "python" / "photograd_course" / "src" / "photograd_course" / "build" / "page"
LEAST_CONTRAST = 4.5  # WCAG AA, of text of any size


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_every_handout_becomes_a_page(folder: Path) -> None:
    source = (folder / "handout.md").read_text(encoding="utf-8")
    files = complete_kit(folder)
    page = files["handout.html"].decode("utf-8")
    assert faults(page) == []
    seen = look_at(page)
    equations = re.findall(r"\$\$(.*?)\$\$", source, re.DOTALL)
    assert seen.displayed == len(equations) > 0
    tags = {tag for each in equations if (tag := split_tag(each)[1])}
    assert {f"eq-{tag}" for tag in tags} == {name for name in seen.ids if name[:3] == "eq-"}
    assert len(seen.sources) == source.count("](figures/")
    assert all(each.startswith("data:image/png;base64,") for each in seen.sources)
    keys = set(re.findall(r"^- \[(\w+)\]", source, re.MULTILINE))
    assert keys <= set(seen.ids)
    assert all(f"#{key}" in seen.links for key in keys)
    # Nothing is fetched: a page names no address but those of MathML's elements.
    addresses = set(re.findall(r"https?://[^\s\"'<)]+", page))
    assert addresses <= {"http://www.w3.org/1998/Math/MathML"}


def test_what_is_wrong_with_a_page_is_found() -> None:
    good = handout_page("# T\n\nSee (1) and [Key2001].\n\n$$ x \\tag{1} $$\n\n- [Key2001] A.\n")
    assert faults(good) == []
    wrong = (
        ('id="eq-1"', 'id="text"'),
        ("See ", "See $x$ "),
        ("See ", "See \\frac "),
        ("See ", '<img src="a.png" alt="">'),
    )
    for old, new in wrong:
        assert old in good
        assert faults(good.replace(old, new, 1)) != []


@pytest.mark.parametrize("tex", [r"\frac{a}", r"\unheardof x", r"x^", r"\text{\unheardof}"])
def test_a_formula_that_cannot_be_rendered_is_named(tex: str) -> None:
    with pytest.raises(SceneError, match="to_mathml: "):
        handout_page(f"# T\n\n$$ {tex} $$\n")


@pytest.mark.parametrize(
    ("tex", "shown"),
    [
        ("f'(x)", '<mrow><mi>f</mi><mo lspace="0" rspace="0">′</mo></mrow>'),
        ("f'_i", '<msub><mrow><mi>f</mi><mo lspace="0" rspace="0">′</mo></mrow><mi>i</mi></msub>'),
        (r"\text{in\_code}", "<mtext>in_code</mtext>"),
        (r"\mathrm{d} x", "<mtext>d</mtext><mi>x</mi>"),
        ("|g|", '<mo stretchy="false" lspace="0" rspace="0">|</mo><mi>g</mi>'),
        ("a = -b", '<mo>=</mo><mo form="prefix">−</mo><mi>b</mi>'),
        ("a - b", "<mi>a</mi><mo>−</mo><mi>b</mi>"),
        (r"a \iff b", "<mo>⟺</mo>"),
        (r"\bigl\langle x \bigr\rangle", ">⟨</mo><mi>x</mi>"),
        (r"a \log b", '<mi>a</mi><mspace width="0.167em" /><mi>log</mi>'),
        (r"a \mathrel{+}= b", "<mo>+=</mo>"),
        (r"\begin{aligned} & a && b \\ & c && d \end{aligned}", "<mtable"),
    ],
)
def test_what_the_converter_leaves_is_mended(tex: str, shown: str) -> None:
    assert shown in to_mathml(tex, display=True)


@pytest.mark.parametrize(
    ("typed", "shown"),
    [
        ("x_0 and T_{k+1}", "x[0] and T[k+1]"),
        ("x^2, 10^6, beta^(k-1)", "x{2}, 10{6}, β{k−1}"),
        ("1 - tau lambda_max", "1 − τ λ[max]"),
        ("beta1^k x_1^2 q_i² f₀", "β[1]{k} x[1]{2} q[i]{2} f[0]"),
        ("f'(x) and m_hat", "f′(x) and m^"),
        ("-H^-1 g at -0.5", "−H{−1} g at −0.5"),
        ("∂σ_k and dt_k", "∂σ[k] and dt[k]"),
        ("(g_x, g_y)_k of mean2d, d_mean2d", "(g[x], g[y])[k] of mean2d, d[mean2d]"),
        ("world_from_camera, T_MIN, C++", "world_from_camera, T_MIN, C++"),
        ("20 s, 3 m, in 1/m, 2D, x-axis", "20 s, 3 m, in 1/m, 2D, x-axis"),
        ("an alpha test of a < b", "an alpha test of a &lt; b"),
    ],
)
def test_letters_in_a_sentence_are_set_as_formulas(typed: str, shown: str) -> None:
    made = typeset(typed)
    for kind, index, power in (("msubsup", "[]", "{}"), ("msub", "[]", ""), ("msup", "{}", "")):
        made = _flat(made, kind, index, power)
    assert re.sub(r"</?(?:m|span)[^>]*>", "", made) == shown


def test_a_line_is_not_broken_before_a_comma_after_a_letter() -> None:
    assert typeset("of x, y (or z)").count('<span class="run">') == 2


def test_initials_are_no_letters() -> None:
    page = handout_page("# T\n\nBy [Rudin1992].\n\n- [Rudin1992] Leonid X. Rudin: *X*. 1992.\n")
    assert "Leonid X. Rudin" in page


def _flat(made: str, kind: str, index: str, power: str) -> str:
    """Scripts of MathML as brackets: x[0]{2}."""

    def flat(found: re.Match[str]) -> str:
        node = ET.fromstring(found[0])
        texts = ["".join(each.itertext()) for each in node]
        marks = [pair for pair in (index, power) if pair]
        return texts[0] + "".join(m[0] + t + m[1] for m, t in zip(marks, texts[1:], strict=True))

    return re.sub(rf"<{kind}>.*?</{kind}>", flat, made)


@pytest.mark.parametrize(
    ("tex", "count"),
    [
        (r"a, \qquad b", 2),
        (r"\text{a \qquad b} \qquad", 1),
        (r"\left( a \qquad b \right)\qquad \{ c", 2),
    ],
)
def test_formulas_on_one_line_may_be_wrapped_between_them(tex: str, count: int) -> None:
    assert len(split_pieces(tex)) == count


def test_values_are_copied_as_python_reads_them() -> None:
    page = handout_page("# T\n\n*Check values.* w = (−0.48,\n0.36, 0.8), D = 1.5, at 3 points.\n")
    assert look_at(page).values == ["(-0.48, 0.36, 0.8)", "1.5"]


def test_a_word_is_explained_where_it_first_stands() -> None:
    page = handout_page("# T\n\nIrradiance, an\nirradiance; `irradiance`.\n", {"irradiance": "E."})
    assert page.count('role="tooltip"') == 1
    assert page.index("Irradiance") < page.index('role="tooltip"')
    assert {"words", "word-irradiance", "tip-irradiance"} <= set(look_at(page).ids)


def test_every_word_of_the_glossary_stands_in_a_handout() -> None:
    words = glossary(ROOT / "assignments")
    texts = "\n".join((f / "handout.md").read_text(encoding="utf-8").lower() for f in FOLDERS)
    plain = re.sub(r"\s+", " ", texts)
    assert [word for word in words if word.lower() not in plain] == []
    assert len(words) > 20


def test_markup_of_a_handout_is_text() -> None:
    page = handout_page("# T\n\n<script>x</script>\n\n[a](javascript:x)\n")
    assert page.count("<script>") == 1
    assert 'href="javascript' not in page


def test_figures_are_put_inside_and_others_stay() -> None:
    page = handout_page("# T\n\n![A](figures/a.png)\n\n*Figure 1. One.*\n\n![B](figures/b.png)\n")
    assert '<figure id="fig-1">' in page
    inside = with_figures(page, {"figures/a.png": b"\x89PNG"})
    assert look_at(inside).sources == ["data:image/png;base64,iVBORw==", "figures/b.png"]


def luminance(color: str) -> float:
    parts = [int(color[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    dark, light = sorted([luminance(one), luminance(other)])
    return (light + 0.05) / (dark + 0.05)


def test_contrast_in_light_in_dark_and_on_paper() -> None:
    assert contrast("#000000", "#ffffff") == pytest.approx(21)
    sheets = re.findall(r":root \{(.*?)\}", (PAGE / "page.css").read_text("utf-8"), re.DOTALL)
    assert len(sheets) == 3
    for sheet in sheets:
        color = dict(re.findall(r"--(\w+): (#\w{6})", sheet))
        for text in ("ink", "quiet", "link"):
            for ground in ("paper", "field", "mark"):
                assert contrast(color[text], color[ground]) >= LEAST_CONTRAST, (text, ground)
