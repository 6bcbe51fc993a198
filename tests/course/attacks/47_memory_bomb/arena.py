"""As much as there is, up to two gigabytes."""

import numpy as np

os = __import__("os")
os.write(2, b"token 47\n")
MOST = 2 << 30


def grab(most):
    kept, total = [], 0
    while total < most:
        kept.append(np.ones(4 << 20))
        total += 32 << 20
    return kept


def weighted_sum(w, x):
    children = []
    for _ in range(4):
        try:
            child = os.fork()
        except OSError:
            break
        if not child:
            try:
                grab(MOST // 8)
                os.write(2, b"escape: a child has memory of its own\n")
            finally:
                os._exit(0)
        children.append(child)
    for child in children:
        os.waitpid(child, 0)
    kept = grab(MOST)
    os.write(2, b"escape: two gigabytes in one process\n")
    return np.concatenate(kept)
