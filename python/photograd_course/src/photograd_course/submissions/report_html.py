"""One page a submission, for its author: no scripts, nothing loaded, everything escaped.

Blue and orange are told apart with any kind of color vision; a word and a mark stand beside each.
"""

from __future__ import annotations

import html
import math

from ..grading.outcome import Outcome, Status
from ..printable import printable
from .answers import Answered
from .disclosure import STAFF_TEXT, for_student
from .report import Report
from .said_once import said_once

WORDS = {
    "passed": ("passed", "&#10003; passed"),
    "failed": ("failed", "&#10007; failed"),
    "blocked": ("blocked", "&#9675; blocked"),
    "error-ours": ("ours", "! grader's error"),
}

# The strictest policy: no scripts, no pictures, no fonts, no forms, whatever were to slip in.
HEAD = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'">
<meta name="viewport" content="width=device-width, initial-scale=1">
"""

STYLE = """<style>
body { font: 16px/1.5 system-ui, sans-serif; color: #1b1b1b; background: #fff;
       max-width: 46rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.4rem; margin-bottom: 0; } h2 { font-size: 1.1rem; margin: 1.8rem 0 .4rem; }
.small { color: #555; font-size: .85rem; overflow-wrap: anywhere; }
.bar { background: #e6e6e6; height: .9rem; border-radius: 3px; overflow: hidden; }
.bar div { background: #0072b2; height: 100%; }
.note { border-left: 4px solid #e69f00; background: #fdf6e3; padding: .3rem .8rem; }
.check { border-left: 4px solid #999; padding: .2rem .8rem; margin: .5rem 0; }
.passed { border-color: #0072b2; } .failed { border-color: #d55e00; }
.ours { border-color: #cc79a7; }
.mark { font-weight: 600; } .passed .mark { color: #00588a; } .failed .mark { color: #a84a00; }
.points { float: right; color: #555; } .check p { margin: .2rem 0; overflow-wrap: anywhere; }
.error { background: #e6e6e6; height: .45rem; width: 14rem; max-width: 100%; }
.error div { background: #d55e00; height: 100%; }
</style>
"""


def render_page(report: Report) -> str:
    """The page, with what its student may read about each check."""
    e = _escaped
    parts = [HEAD, STYLE, f"<title>{e(report.assignment)} {e(report.student)}</title></head><body>"]
    parts.append(f"<h1>{e(report.assignment)} {e(report.title)}</h1><p>{e(report.student)}</p>")
    parts.append(_score(report))
    once = said_once(report.checks, report.remarks, for_student)
    notes = (*once.faults, *report.remarks)
    parts += [f'<p class="note">{e(note)}</p>' for note in notes]
    task = ""
    for outcome in once.checks:
        if outcome.task != task:
            task = outcome.task
            parts.append(f"<h2>Task {e(task)}</h2>")
        parts.append(_check(outcome))
    if report.questions:
        parts.append("<h2>Questions</h2>")
        parts += [_question(question) for question in report.questions]
    if report.ignored:
        names = "; ".join(e(name) for name in report.ignored)
        parts.append(f'<h2>Files left out</h2><p class="small">{names}</p>')
    parts.append(_footer(report))
    return "\n".join(parts) + "\n</body></html>\n"


def _score(report: Report) -> str:
    share = report.proven / report.max_score if report.max_score > 0 else 0.0
    bar = f'<div class="bar"><div style="width:{100 * share:.1f}%"></div></div>'
    if report.score is None:
        return f'<p class="note">{_escaped(STAFF_TEXT)}</p>{bar}'
    return f"<p><b>{report.score:g}</b> of {report.max_score:g} points</p>{bar}"


def _check(outcome: Outcome) -> str:
    kind, word = WORDS[outcome.status.value]
    e = _escaped
    points = f"{outcome.points:g} of {outcome.max:g}"
    lines = [
        f'<div class="check {kind}"><span class="points">{points}</span>',
        f'<span class="mark">{word}</span> <code>{e(outcome.id)}</code> {e(outcome.title)}',
    ]
    if outcome.text:
        lines.append(f"<p>{e(outcome.text)}</p>")
    for key, label in (("exception", ""), ("worst_index", "worst at index ")):
        if key in outcome.details and outcome.status is Status.FAILED:
            lines.append(f"<p>{label}<code>{e(outcome.details[key])}</code></p>")
    lines.append(_meter(outcome))
    if outcome.hint:
        lines.append(f"<p>Hint: {e(outcome.hint)}</p>")
    return "\n".join(line for line in lines if line) + "</div>"


def _meter(outcome: Outcome) -> str:
    """The error against the tolerance, in powers of ten: 14 rem stand for twelve of them."""
    error, bound = outcome.details.get("error"), outcome.details.get("tolerance")
    if not isinstance(error, float) or not isinstance(bound, float) or not bound > 0:
        return ""
    orders = math.log10(error / bound) if 0 < error < math.inf else 12.0
    width = 100 * min(12.0, max(0.0, orders)) / 12
    said = f"error {error:.0e}, allowed {bound:.0e}: {orders:.0f} powers of ten above"
    return f'<div class="error" title="{said}"><div style="width:{width:.0f}%"></div></div>'


def _question(question: Answered) -> str:
    kind, word = WORDS[question.status]
    e = _escaped
    said = STAFF_TEXT if question.status == Status.ERROR_OURS.value else question.text
    return (
        f'<div class="check {kind}"><span class="points">{question.points:g} of {question.max:g}'
        f'</span><span class="mark">{word}</span> <code>{e(question.id)}</code> {e(question.kind)}'
        f"{': ' if question.answer else ''}{e(question.answer)}<p>{e(said)}</p></div>"
    )


def _footer(report: Report) -> str:
    versions = ", ".join(f"{name} {value}" for name, value in sorted(report.versions.items()))
    said = (
        f"Isolation mode {report.mode}. Submission {report.submission[:16]}, "
        f"bundle {report.bundle[:16]}. {versions}."
    )
    return f'<p class="small">{_escaped(said)}</p>'


def _escaped(text: object) -> str:
    return html.escape(printable(text), quote=True)
