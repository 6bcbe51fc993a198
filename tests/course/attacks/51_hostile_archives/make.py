"""One archive for each trick."""

from course.attacks.archive import DEVICE, LINK, zip_of

MODULE = '__import__("os").write(2, b"token 51\\n")\n'
POISON = "def weighted_sum(w, x):\n    return 1e9\n"


def encrypted() -> bytes:
    data = bytearray(zip_of({"arena.py": MODULE}))
    for mark, at in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        data[data.index(mark) + at] |= 1
    return bytes(data)


def links() -> bytes:
    targets = {"arena.py": "../grader/solution.py", "answers.toml": "/etc/passwd", "up": ".."}
    return zip_of(targets, dict.fromkeys(targets, LINK))


def variants() -> dict[str, bytes]:
    whole = zip_of({"arena.py": MODULE})
    return {
        "traversal": zip_of({"arena.py": MODULE, "../other/arena.py": POISON, "../escaped": "x"}),
        "backslashes": zip_of({"arena.py": MODULE, "..\\..\\escaped": "x"}),
        "absolute": zip_of({"arena.py": MODULE, "/tmp/photograd-attack-absolute": "x"}),
        "links": links(),
        "device": zip_of({"arena.py": ""}, {"arena.py": DEVICE}),
        "bomb": zip_of({"arena.py": b"#" * (100 << 20)}),
        "nested": zip_of({"inner.zip": whole, "arena.py": MODULE}),
        "collisions": zip_of({"arena.py": MODULE, "ARENA.PY": POISON, "Arena.py": POISON}),
        "twice": zip_of([("arena.py", MODULE), ("arena.py/", ""), ("./arena.py", POISON)]),
        "hooks": zip_of({"arena.py": MODULE, ".git/hooks/post-checkout": "#!/bin/sh\n"}),
        "many": zip_of([("arena.py", MODULE), *((f"{n}", "") for n in range(20_000))]),
        "encrypted": encrypted(),
        "truncated": whole[:-30],
        "homoglyph": zip_of({"\u0430rena.py": MODULE, "aren\u0430.py": POISON}),
    }
