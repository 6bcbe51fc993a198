"""The files of a new assignment: small, complete, and keeping every build rule.

``NN`` stands for the number and ``NAME`` for the name.
"""

from __future__ import annotations

MANIFEST = """\
id = "NN"
name = "NAME"
title = "NAME"
module = "NAME"
submission = ["NAME.py", "answers.toml"]
prerequisites = []
hours = 1
imports = ["numpy"]
vocabulary = []
points = { code = 75, questions = 25 }

[[tasks]]
id = "NN.1"
title = "Twice as much"
functions = ["twice"]
"""

MODULE = '''\
"""Replace this by what the assignment is about, with its formula and units.

Your task is the function below; `photograd course check NN` tells how far you are.
"""

from __future__ import annotations

import numpy as np


def twice(x: np.ndarray) -> np.ndarray:
    """Twice the values x (N,), float64, in the unit of x."""
    # >>> solution NN.1
    return 2.0 * x
    # <<< solution
'''

CHECKS = '"""Public checks of assignment NN, a file for each task."""\n'

PUBLIC = '''\
"""Task NN.1, public checks."""

from __future__ import annotations

import numpy as np
from photograd_course.grading import Array, Tolerance, check

ROUNDING = Tolerance(1e-12, "doubling is exact; the nearest wrong answer is off by half")


@check(
    "NN.1.known",
    points=40,
    calls=("twice",),
    tolerance=ROUNDING,
    hint="handout, section 1",
    sole="students need a public check; the hidden one looks at other points",
)
def known_values_are_doubled(t):
    """1, 2 and 5 become 2, 4 and 10."""
    known = np.array([1.0, 2.0, 5.0])
    t.close("y", t.call("twice", known, returns=Array((3,))), [2.0, 4.0, 10.0], reveal=True)
'''

HIDDEN = '"""Hidden checks of assignment NN: no file of this folder is in a kit."""\n'

HIDDEN_TASK = '''\
"""Task NN.1, hidden checks."""

from __future__ import annotations

from photograd_course.grading import Array, Subject, hidden_check

from ..task_1 import ROUNDING


@hidden_check(
    "NN.1.random",
    points=35,
    calls=("twice",),
    tolerance=ROUNDING,
    sole="random points, so that the answers to the public check cannot be copied",
    battery=[
        Subject(
            "twice",
            lambda t, n: (t.rng.uniform(-3.0, 3.0, n),),
            lambda n: Array((n,)),
            sizes=(0, 1, 100),
            rows=(0,),
        )
    ],
)
def random_values_are_doubled(t):
    """Random values are doubled."""
    x = t.rng.uniform(-3.0, 3.0, 8)
    t.close("y", t.call("twice", x, returns=Array((8,))), t.reference.twice(x))
'''

QUESTIONS = """\
[[prediction]]
id = "NN.p1"
points = 5
text = "What becomes of -3?"
options = ["-6", "6"]

[[concept]]
id = "NN.q1"
points = 20
text = "How many times does x count in the result?"
answer = 2
because = "it is doubled"
"""

HANDOUT = """\
# NN NAME

What this is about and why, in a page that stands alone.

## 1. Twice as much

Write `twice`. For x = 3 it gives 6.
"""

EXPLORE = """\
# %% [markdown]
# Play here; nothing of this is graded.

# %%
import numpy as np
from NAME import twice

print(twice(np.array([1.0, 2.0])))
"""

MUTANTS = """\
# The checks that a mutant loses, what a student with this mistake is told, old and new text.

["NN.1"]
not_doubled = ["known random",
  "Your result equals x itself: it is not doubled.",
  "return 2.0 * x", "return 1.0 * x"]
squared = ["known random",
  "Your result is the square of x: the product of x with itself, not with two.",
  "return 2.0 * x", "return x * x"]
"""

ALTERNATIVE = '''\
"""WHAT"""

from __future__ import annotations

import numpy as np


def twice(x):
    return BODY
'''


def template(number: str, name: str) -> dict[str, str]:
    """The files by path."""
    ways = {
        "scalar_loops": ("Scalar loops.", "np.array([value + value for value in x])"),
        "vectorized": ("Vectorized: a sum.", "x + x"),
        "handout_alone": ("Written from the handout alone.", "np.multiply(x, 2.0)"),
    }
    files = {
        "assignment.toml": MANIFEST,
        f"{name}.py": MODULE,
        "checks/__init__.py": CHECKS,
        "checks/task_1.py": PUBLIC,
        "checks/hidden/__init__.py": HIDDEN,
        "checks/hidden/task_1.py": HIDDEN_TASK,
        "questions.toml": QUESTIONS,
        "handout.md": HANDOUT,
        "explore.py": EXPLORE,
        "mutants.toml": MUTANTS,
    }
    for way, (what, body) in ways.items():
        text = ALTERNATIVE.replace("WHAT", what).replace("BODY", body)
        files[f"alternatives/{way}.py"] = text
    return {path: text.replace("NN", number).replace("NAME", name) for path, text in files.items()}
