"""Papers of one's own making."""

import json

from course.attacks.archive import zip_of

MODULE = '__import__("os").write(2, b"token 56\\n")\n'
RECEIPT = {"student": "somebody else", "public_points": 21, "time": "2000-01-01T00:00:00Z"}
ANSWERS = """student = "somebody else"
score = 25
points = 25
[report]
score = 25
[answers]
"91.p1" = "a"
"""


def variants() -> dict[str, bytes]:
    files = {
        "arena.py": MODULE,
        "answers.toml": ANSWERS,
        "receipt.json": json.dumps(RECEIPT),
        "submission_metadata.json": json.dumps({**RECEIPT, "id": 1, "previous_submissions": []}),
        "results.json": json.dumps({"score": 25}),
        "record.json": json.dumps({"report": {"score": 25}, "seal": "0" * 64}),
    }
    return {"papers": zip_of(files)}
