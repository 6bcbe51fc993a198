"""The loss of an image, and its gradient.

`loss` is done. One line is missing in `loss_gradient`: find it with the handout, write it, and run
`photograd course check 00` again.
"""

from __future__ import annotations

import numpy as np


def loss(picture: np.ndarray, photograph: np.ndarray) -> float:
    """Mean squared error, Eq. (1), of two images (H, W), float64, of one unit; in its square."""
    return float(np.mean((picture - photograph) ** 2))


def loss_gradient(picture: np.ndarray, photograph: np.ndarray) -> np.ndarray:
    """Derivative of `loss` with respect to each pixel of `picture`, Eq. (2): (H, W), float64."""
    # >>> solution 00.1
    return 2.0 * (picture - photograph) / picture.size
    # <<< solution
