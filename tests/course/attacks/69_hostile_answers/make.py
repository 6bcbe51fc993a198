"""One answers.toml for each trick; the module solves nothing."""

import hashlib
import json

from course.attacks.archive import zip_of

MODULE = "# nothing\n"
MADE = {"91.p1": "a"}
LOCK = {"assignment": "91", "answers": MADE, "locked_at": "1970-01-01", "sha256": "0" * 64}


def right_lock() -> str:
    """With the checksum that anybody can compute."""
    text = json.dumps({"assignment": "91", "answers": MADE})
    return json.dumps({**LOCK, "sha256": hashlib.sha256(text.encode()).hexdigest()})


def variants() -> dict[str, bytes]:
    texts = {
        "nested": "a = " + "[" * 30_000 + "]" * 30_000 + "\n",
        "tables": "[" + ".".join("a" * 30_000) + "]\nx = 1\n",
        "digits": '[answers]\n"91.c1" = ' + "1" * 60_000 + "\n",
        "hex": '[answers]\n"91.c1" = 0x' + "F" * 4000 + "\n",
        "dotted": "a." * 32_000 + "a = 1\n",
        "nan": '[answers]\n"91.c1" = nan\n',
        "infinity": '[answers]\n"91.c1" = "1e999"\n',
        "truth": '[answers]\n"91.c1" = true\n',
        "text": '[answers]\n"91.c1" = "' + "0" * 50_000 + '"\n',
        "date": '[answers]\n"91.c1" = 1979-05-27T07:32:00Z\n',
        "list": '[answers]\n"91.p1" = ["a"]\n"91.c1" = [1.0]\n',
        "keys": "[answers]\n" + "".join(f"k{n} = 1\n" for n in range(5000)),
        "claims": 'score = 25\n[answers]\n"91.p1" = "a"\n[predictions]\nlocked = true\n',
        "not_utf8": b"\xff\xfe\xfd",
        "too_long": "# " + "x" * 200_000,
    }
    made = {
        name: zip_of({"arena.py": MODULE, "answers.toml": text}) for name, text in texts.items()
    }
    locks = {
        "lock": json.dumps(LOCK),
        "lock_right": right_lock(),
        "lock_nested": "[" * 60_000,
        "lock_nan": '{"answers": NaN}',
    }
    for name, text in locks.items():
        answers = '[answers]\n"91.p1" = "a"\n'
        files = {"arena.py": MODULE, "answers.toml": answers, "predictions.lock.json": text}
        made[name] = zip_of(files)
    # Each quote is none that closes the one before.
    answers = '[answers]\n"91.c1" = 1\n'
    made["quotes"] = zip_of({"arena.py": "'" + "\\'" * 100_000, "answers.toml": answers})
    return made
