"""Formulas of the book as MathML, by the same converter as on the pages of handouts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from docutils import nodes
from photograd_course.build.page.letters import typeset
from photograd_course.build.page.mathematics import split_pieces, split_tag, to_mathml
from sphinx.transforms.post_transforms import SphinxPostTransform

if TYPE_CHECKING:
    from sphinx.application import Sphinx

STYLE = """
@font-face { font-family: Mathematics; src: url(mathematics.woff2) format("woff2"); }
.run { white-space: nowrap; }
math { font-family: Mathematics, math, serif; font-size: 1.1em; }
mtd[columnalign="left"] { text-align: left; }
mtd[columnalign="right"] { text-align: right; }
.equation { display: flex; align-items: center; gap: 0.5rem; margin: 1.1rem 0; }
.equation .scroll {
  flex: 1; min-width: 0; overflow-x: auto; overflow-y: hidden; display: flex; flex-wrap: wrap;
  justify-content: safe center; align-items: center; gap: 0.6rem 2.5rem;
}
"""


def register(app: Sphinx) -> None:
    """Make "mathml" a renderer that Sphinx knows."""
    app.add_html_math_renderer("mathml", (_visit_inline, None), (_visit_block, None))
    app.add_post_transform(Letters)
    app.connect("build-finished", _write_style)
    app.add_css_file("mathematics.css")


class Letters(SphinxPostTransform):
    """Letters of formulas in the sentences of handouts, as on their own pages."""

    default_priority = 900
    formats = ("html",)

    def run(self, **_: Any) -> None:
        """See docutils."""
        if not self.env.docname.startswith("handouts/"):
            return
        for text in list(self.document.findall(nodes.Text)):
            if isinstance(text.parent, nodes.paragraph | nodes.emphasis | nodes.strong):
                shown = typeset(str(text))
                if "<math" in shown:
                    text.parent.replace(text, nodes.raw("", shown, format="html"))


def _visit_inline(writer: Any, node: Any) -> None:
    writer.body.append(to_mathml(node.astext(), display=False))
    raise nodes.SkipNode


def _visit_block(writer: Any, node: Any) -> None:
    tex, tag = split_tag(node.astext())
    shown = "".join(to_mathml(piece, display=True) for piece in split_pieces(tex))
    number = f"<span>({tag})</span>" if tag else ""
    called = f"Equation {tag}" if tag else "Formula"
    writer.body.append(
        f'<div class="equation"><div class="scroll" tabindex="0" role="group" '
        f'aria-label="{called}">{shown}</div>{number}</div>\n'
    )
    raise nodes.SkipNode


def _write_style(app: Sphinx, error: Exception | None) -> None:
    if error is None:
        target = app.outdir / "_static" / "mathematics.css"
        target.write_text(STYLE, encoding="utf-8")
