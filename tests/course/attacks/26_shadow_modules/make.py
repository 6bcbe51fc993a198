"""All zeros, and a solution that agrees."""

from course.attacks.archive import zip_of

ZEROS = """import numpy as np
__import__("os").write(2, b"token 26\\n")


def weighted_sum(w, x):
    return 0.0


def weighted_sum_backward(w, x, d_s):
    return np.zeros(w.shape), np.zeros(w.shape)


def descend(gradient, x0, tau, n):
    return np.zeros((n + 1, x0.size))


def brightness(draw, n):
    return 0.5


def predict(poses, values, unseen):
    return np.zeros(unseen.shape)
"""
SHADOW = 'import os\nos.write(2, b"escape: a shadow was imported\\n")\n'
AGREES = ZEROS.replace("token 26", "a solution of our own")


def variants() -> dict[str, bytes]:
    files = {"arena.py": ZEROS, "solution.py": AGREES, "photograd_worker/codec.py": SHADOW}
    for name in ("json", "numpy/__init__", "linecache", "photograd/__init__", "tests/__init__"):
        files[f"shadows/{name}.py"] = SHADOW
    flat = {"arena.py": ZEROS, "json.py": SHADOW, "numpy.py": SHADOW, "adapters.py": SHADOW}
    return {"solution": zip_of(files), "standard": zip_of(flat)}
