"""Modules that are hard to read, parse or compile."""

TOKEN = '__import__("os").write(2, b"token 54\\n")\n'
FUNCTION = "def weighted_sum(w, x):\n    return 0.0\n"


def copies_of_copies(depth: int) -> str:
    """Each finally is compiled twice, so the innermost 2 to the power of `depth` times."""
    lines, indent = [], ""
    for level in range(depth):
        lines += [f"{indent}try: pass", f"{indent}finally:"]
        indent += " "
        if level % 15 == 14:
            lines += [f"{indent}def f():"]
            indent += " "
    return "\n".join([*lines, f"{indent}x = 1", ""])


def variants() -> dict[str, bytes]:
    hidden = TOKEN.encode("utf-7").decode() + "raise SystemExit\n"
    texts = {
        "finally": TOKEN + copies_of_copies(45) + FUNCTION,
        "nul": TOKEN + "\0" + FUNCTION,
        "brackets": "x = " + "(" * 90_000 + ")" * 90_000 + "\n" + FUNCTION,
        "signs": "x = " + "-" * 190_000 + "1\n" + FUNCTION,
        "attributes": "x = a" + ".a" * 90_000 + "\n" + FUNCTION,
        "digits": "x = " + "9" * 190_000 + "\n" + FUNCTION,
        "strings": "x = (" + "''" * 90_000 + ")\n" + FUNCTION,
        "cookie": "# coding: utf-7\n" + hidden + FUNCTION,
        "unknown_cookie": "# coding: no-such-thing\n" + TOKEN + FUNCTION,
        "look_alikes": TOKEN + "def w\u0435ighted_sum(w, x):\n    return 0.0\n",
        "elifs": TOKEN + "if 0: pass\n" + "elif 0: pass\n" * 12_000 + FUNCTION,
    }
    made = {name: text.encode() for name, text in texts.items()}
    made["utf_16"] = (TOKEN + FUNCTION).encode("utf-16")
    made["too_long"] = FUNCTION.encode() + b"#" * (300 << 10)
    return made
