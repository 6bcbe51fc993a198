"""SVG out and in again, beside a second renderer; files that are refused."""

from __future__ import annotations

import io
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import Error, IoError
from photograd.vector import (
    Drawing,
    Flattening,
    Shape,
    Solid,
    read_svg,
    render,
    svg_text,
    write_svg,
)
from photograd.vector.svg_path import path_subpaths
from PIL import Image

from support.missing import need_module
from tests.vector.oracle import SIZE, everything, polygon

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" width="40" height="30"'
FEATURES = f"""{HEAD} viewBox="-5 -5 80 60">
<title>skipped</title>
<defs>
  <linearGradient id="a"><stop offset="10%" stop-color="red"/>
    <stop offset=".9" style="stop-color:#00f;stop-opacity:.4"/></linearGradient>
  <radialGradient id="b" gradientUnits="userSpaceOnUse" cx="60" cy="40" r="14"
    gradientTransform="translate(-2 1)"><stop stop-color="#fff"/><stop offset="1"/></radialGradient>
</defs>
<rect x="2" y="3" width="30" height="20" fill="url(#a)"/>
<g fill="#0a0" transform="translate(30,4) rotate(20) scale(1.5)" stroke="navy">
  <path d="m3 2 h8v4q5 0 5 6t-4 3zM5 4l2 1-1 2z" stroke-width="1.2" stroke-linejoin="round"/>
  <circle cx="2" cy="14" r="3" fill-opacity="50%"/>
</g>
<path d="M5 30a9 6 30 1 1 12 8A5 5 0 004 40C10 60 20 20 24 50S30 30 40 48" fill="none"
  style="stroke:#c40;stroke-width:2;stroke-linecap:square" opacity=".7"/>
<ellipse cx="60" cy="40" rx="12" ry="9" fill="url(#b)"/>
<polygon points="45,30 60,28 44,40 58,22 52,44" fill="gold" fill-rule="evenodd"/>
<polyline points="2 48,8 52 14 47" fill="none" stroke="black" stroke-linecap="round"/>
<line x1="60" y1="2" x2="72" y2="20" stroke="purple" stroke-width="3" visibility="visible"/>
</svg>"""


FINE = Flattening(tolerance=0.005)


def enlarged(text: str) -> str:
    """The same file, 16 times as large."""
    sizes = re.compile(r'width="(\d+)" height="(\d+)"')
    return sizes.sub(lambda m: f'width="{16 * int(m[1])}" height="{16 * int(m[2])}"', text, 1)


def second_renderer(text: str) -> Any:
    """(H, W, 4) premultiplied, by resvg."""
    resvg = need_module("resvg_py")
    with Image.open(io.BytesIO(bytes(resvg.svg_to_bytes(svg_string=text)))) as opened:
        pixels = np.asarray(opened.convert("RGBA"), np.float64) / 255
    pixels[..., :3] *= pixels[..., 3:]
    return pixels


def reduced(pixels: Any) -> Any:
    height, width = pixels.shape[0] // 16, pixels.shape[1] // 16
    return pixels.reshape(height, 16, width, 16, 4).mean(axis=(1, 3))


@pytest.mark.parametrize("shape", range(7))
def test_a_second_renderer_draws_what_we_write(shape: int) -> None:
    """Areas against 256 of its pixels; paint, at the centers of ours, against its mean."""
    alone = Drawing.of([everything().shapes[shape]])
    found = reduced(second_renderer(enlarged(svg_text(alone, SIZE, linear=False))))
    tolerance = 0.05 if alone.layout.kind[0] else 0.03
    np.testing.assert_allclose(render(alone, SIZE, flattening=FINE), found, atol=tolerance)


def test_a_second_renderer_draws_what_we_read() -> None:
    assert read_svg(FEATURES.encode()).size == (30, 40)
    found = read_svg(enlarged(FEATURES).encode(), linear=False)
    assert len(found.drawing.shapes) == 11
    mine, other = render(found.drawing, found.size), second_renderer(enlarged(FEATURES))
    np.testing.assert_allclose(reduced(mine), reduced(other), atol=0.02)
    assert np.abs(mine - other).mean() < 2e-3


def test_files_of_others_look_as_a_second_renderer_draws_them(shared_data: Path) -> None:
    """Logos and emoji; refused are gradients that a transform made elliptic."""
    files = sorted((shared_data / "svg").glob("*/*.svg"))
    refused = []
    for file in files:
        try:
            found = read_svg(file, linear=False)
        except IoError as failure:
            refused.append(str(failure))
            continue
        mine, other = render(found.drawing, found.size), second_renderer(file.read_text("utf-8"))
        assert np.abs(mine - other).mean() < 0.006, file
        assert np.abs(mine - other).max() < 0.25, file  # it takes few samples of a pixel
    assert len(files) > 40
    assert len(refused) <= 3
    assert all("for a gradient" in text for text in refused)


@pytest.mark.parametrize("linear", [False, True])
def test_what_is_written_is_read_again(tmp_path: Path, linear: bool) -> None:
    drawing = everything()
    write_svg(tmp_path / "a.svg", drawing, SIZE, linear=linear, background=np.array([1, 0.5, 0]))
    again = read_svg(tmp_path / "a.svg", linear=linear)
    assert again.size == SIZE
    behind = polygon([[0, 0], [31, 0], [31, 26], [0, 26]], paint=Solid((1, 0.5, 0)))
    whole = Drawing.of([behind, *drawing.shapes])
    np.testing.assert_allclose(render(again.drawing, SIZE), render(whole, SIZE), atol=0.005)


def test_arcs_are_circles() -> None:
    (path,) = path_subpaths("M 30 20 A 10 10 0 1 0 10 20 A 10 10 0 1 0 30 20 Z")
    assert path.closed
    area = render(Drawing.of([Shape((path,))]), (40, 40), flattening=FINE)[..., 3].sum()
    assert area == pytest.approx(100 * np.pi, rel=1e-3)


@pytest.mark.parametrize("data", ["M1 2L3", "L1 2", "M1 2 X", "M0 0a1 1 0 2 0 1 1", "M 0 nan", "1"])
def test_what_is_no_path_data_is_refused(data: str) -> None:
    with pytest.raises(IoError, match="read_svg: d:"):
        path_subpaths(data)


def laughs() -> str:
    """Entities that grow to a billion words."""
    lines = ['<!ENTITY l0 "lol">'] + [
        f'<!ENTITY l{k} "{f"&l{k - 1};" * 10}">' for k in range(1, 10)
    ]
    return f"<!DOCTYPE svg [{''.join(lines)}]>{HEAD}><title>&l9;</title></svg>"


OUTSIDE = '<!DOCTYPE svg [<!ENTITY x SYSTEM "file:///etc/passwd">]>'


@pytest.mark.parametrize(
    ("text", "what"),
    [
        (laughs(), "without entities"),
        (f"{OUTSIDE}{HEAD}><title>&x;</title></svg>", "without entities"),
        ('<!DOCTYPE svg SYSTEM "http://a/b.dtd">' + HEAD + "/>", "without entities"),
        (f"{HEAD}>{'<g>' * 65}{'</g>' * 65}</svg>", "64 deep"),
        (f"{HEAD}><image href='a.png'/></svg>", "within the file"),
        (f"{HEAD}><path fill='url(b.svg#c)' d='M0 0'/></svg>", "within the file"),
        (f"{HEAD}><path style='fill:url(  http://a/b)' d=''/></svg>", "within the file"),
        (f"{HEAD}><use href='#a'/></svg>", "use"),
        (f"{HEAD}><text>a</text></svg>", "text"),
        (f"{HEAD}><style>*{{}}</style></svg>", "style"),
        (f"{HEAD}><g opacity='.5'/></svg>", "group without opacity"),
        (f"{HEAD}><path clip-path='url(#a)'/></svg>", "clip-path"),
        (f"{HEAD}><path d='M0 0L1 1' fill='url(#a)'/></svg>", "a gradient of this file"),
        (f"{HEAD}><path d='M0 0L1 1' fill='reddish'/></svg>", "a color"),
        (f"{HEAD}><path d='M0 0L1 1' stroke='red' stroke-dasharray='1 2'/></svg>", "dashes"),
        (f"{HEAD}><path d='M0 0L1 1' stroke='red' transform='scale(1 2)'/></svg>", "angles"),
        (f"{HEAD}><path d='M0 0L1 1' transform='spin(2)'/></svg>", "a transform of SVG"),
        (f"{HEAD}><rect width='2em' height='1'/></svg>", "a number of pixels"),
        (f"{HEAD}><rect width='2' height='1' rx='.5'/></svg>", "not rounded"),
        ("<svg xmlns='http://www.w3.org/2000/svg'/>", "a viewBox"),
        (HEAD.replace("40", "1e9") + "/>", "size"),
        ("<html/>", "an element svg first"),
        (f"{HEAD}><path", "XML"),
        ("", "XML"),
    ],
)
def test_what_is_not_read_is_refused(text: str, what: str) -> None:
    with pytest.raises(Error, match=what) as caught:
        read_svg(text.encode())
    assert str(caught.value).startswith("read_svg:")


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(IoError, match="read_svg"):
        read_svg(tmp_path / "none.svg")


def test_damaged_files_raise_typed_errors_alone() -> None:
    rng = np.random.default_rng(1)
    data = np.frombuffer(FEATURES.encode(), np.uint8)
    refused = 0
    for _ in range(300):
        damaged = data.copy()
        where = rng.integers(150, len(data), 3)
        damaged[where] = rng.choice(data, 3)
        try:
            read_svg(damaged.tobytes())
        except Error:
            refused += 1
    assert refused > 30
