"""Letters of formulas in a sentence: x_0, T_{k+1}, 10^6, lambda_max, as they are typed.

A handout types them plainly, so that it can be read as it is; a page shows them as formulas. Names
of code are left alone, in backticks or not: `world_from_camera`.
"""

from __future__ import annotations

import re
from html import escape

GREEK = {
    "alpha": "α",
    "beta": "β",
    "gamma": "γ",
    "delta": "δ",
    "eps": "ε",
    "epsilon": "ε",
    "kappa": "κ",
    "lambda": "λ",
    "mu": "μ",
    "omega": "ω",
    "phi": "φ",
    "rho": "ρ",
    "sigma": "σ",
    "tau": "τ",
    "theta": "θ",
}
WORDS = "|".join(sorted(GREEK, key=len, reverse=True))
# "alpha test" is a word of the field, not a letter with a noun.
PLAIN = r"(?!\s(?:blend|channel|composit|mask|test|value))"
ONE = "A-Za-zΑ-Ωα-ωϕε"
BASE = rf"[∂−-]?(?:d[Itxyzω]|(?:{WORDS})|[{ONE}])"
INDEX = r"(?:_(?:\{[^{}]+\}|[A-Za-z0-9α-ω₀-₉]+(?:_[A-Za-z0-9α-ω]+)*)|[₀-₉]+)"
RAISED = r"(?:\([^()]+\)|\{[^{}]+\}|[-−]?[A-Za-z0-9]+)"
POWER = rf"(?:\^{RAISED}|[⁻⁰¹²³⁴-⁹]+)"
# A word before an index of one letter, such as target_k.
WORD_INDEX = r"[a-z]{3,}_[a-z](?![A-Za-z0-9_])"
LETTERS = re.compile(
    rf"(?<![A-Za-z_α-ω'’.])(?P<name>{BASE})(?P<digit>\d)?(?P<prime>[′']+(?![A-Za-z]))?"
    rf"(?P<index>{INDEX})?(?P<power>{POWER})?(?![A-Za-z0-9_’'α-ω]|\+\+|-[a-z]){PLAIN}"
    rf"|(?<![A-Za-z0-9_])(?P<word>{WORD_INDEX})"
    rf"|(?<=[0-9)²])(?P<raised>\^{RAISED})"
    r"|(?<=\))_(?P<lowered>[a-z])(?![A-Za-z0-9_])"
)
# Single letters that are more often words or units than variables.
NOT_ALONE = {"a", "A"}
PIECE = re.compile(r"[A-Za-z_]{2,}[A-Za-z0-9_]*|[A-Za-zα-ω]|[0-9.]+|.")
MINUS = re.compile(r"(?<=[\w)|²³]) - (?=[\w(|])|(?<![\w.-])-(?=\d)")
SMALL = str.maketrans("₀₁₂₃₄₅₆₇₈₉⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "01234567890123456789−")
UNIT = re.compile(r"\d\s$|\d/$|\bin\s$")
# Around a formula a line is broken at spaces alone: a comma stays with its letter.
RUN = re.compile(r"[^\s<>]*(?:<math>(?:(?!</math>).)*</math>[^\s<>]*)+")


def typeset(text: str) -> str:
    """HTML of a piece of prose, with its letters as MathML."""
    text = MINUS.sub(lambda found: found[0].replace("-", "−"), text)
    parts, at = [], 0
    for found in LETTERS.finditer(text):
        if shown := _shown(found, text):
            parts += [escape(text[at : found.start()], quote=False), shown]
            at = found.end()
    return RUN.sub(_kept_together, "".join([*parts, escape(text[at:], quote=False)]))


def _kept_together(found: re.Match[str]) -> str:
    alone = found[0].startswith("<math>") and found[0].count("<math>") == 1
    if alone and found[0].endswith("</math>"):
        return found[0]
    return f'<span class="run">{found[0]}</span>'


def _shown(found: re.Match[str], text: str) -> str:
    """HTML of a match; "" where it is no letter after all."""
    before = text[: found.start()]
    if found["raised"]:
        return f"<math><msup><mrow></mrow>{_inner(found['raised'][1:])}</msup></math>"
    if found["lowered"]:
        return f"<math><msub><mrow></mrow><mi>{found['lowered']}</mi></msub></math>"
    if found["word"]:
        name, _, index = found["word"].partition("_")
        return f"<math><msub><mtext>{name}</mtext><mi>{index}</mi></msub></math>"
    sign, name = _signed(found["name"])
    index, power = found["index"] or "", found["power"] or ""
    if index[1:].isupper() and len(index) > 2:  # T_MIN, a constant of the code
        return ""
    if before[-1:].isdigit() and name.isascii():  # 2D
        return ""
    bare = not (index or power or found["prime"] or found["digit"])
    if bare and (name in NOT_ALONE or (name in "hms" and UNIT.search(before))):
        return ""
    return _cluster(sign, name, found["digit"] or "", found["prime"] or "", index, power)


def _signed(name: str) -> tuple[str, str]:
    """A sign or ∂ before a letter, and the letter."""
    return (name[0], name[1:]) if name[0] in "∂−-" and len(name) > 1 else ("", name)


def _cluster(sign: str, name: str, digit: str, prime: str, index: str, power: str) -> str:
    base = f"<mi>{GREEK.get(name, name)}</mi>"
    if name[0] == "d" and len(name) == 2:
        base = f"<mrow><mi>d</mi><mi>{name[1]}</mi></mrow>"
    if index == "_hat":
        base, index = f'<mover accent="true">{base}<mo>^</mo></mover>', ""
    if prime:
        marks = prime.replace("'", "′").replace("′′", "″")
        base = f'<mrow>{base}<mo lspace="0" rspace="0">{marks}</mo></mrow>'
    low = _inner(index.removeprefix("_") or digit)
    high = _inner(power.removeprefix("^"))
    if low and high:
        base = f"<msubsup>{base}{low}{high}</msubsup>"
    elif low or high:
        kind = "msub" if low else "msup"
        base = f"<{kind}>{base}{low or high}</{kind}>"
    if sign == "∂":
        base = f"<mi>∂</mi>{base}"
    elif sign:
        base = f'<mo form="prefix">−</mo>{base}'
    return f"<math>{base}</math>"


def _inner(text: str) -> str:
    """What stands in an index or power; "" of nothing."""
    if not text:
        return ""
    bare = (text[1:-1] if text[0] in "({" else text).translate(SMALL)
    parts = [_piece(found[0]) for found in PIECE.finditer(bare)]
    return parts[0] if len(parts) == 1 else f"<mrow>{''.join(parts)}</mrow>"


def _piece(text: str) -> str:
    if text in GREEK or (len(text) == 1 and text.isalpha()):
        return f"<mi>{GREEK.get(text, text)}</mi>"
    if text[0].isdigit() or text[0] in "½¼":
        return f"<mn>{text}</mn>"
    if text[0].isalpha():
        return f"<mtext>{text}</mtext>"
    if text == " ":
        return '<mspace width="0.167em"></mspace>'
    shown = escape(text.replace("-", "−"), quote=False)
    return f"<mo>{shown}</mo>"
