"""The loss of an image, and its gradient.

`loss` is done. One line is missing in `loss_gradient`: find it with the handout, write it, and run
`photograd course check 00` again.
"""

from __future__ import annotations

from typing import Annotated

import numpy as np

# Arrays and their shapes; float64 where nothing else is said.
Image = Annotated[np.ndarray, "H W"]


def loss(picture: Image, photograph: Image) -> float:
    """Mean squared error, Eq. (1), of two images (H, W), float64, of one unit; in its square."""
    return float(np.mean((picture - photograph) ** 2))


def loss_gradient(picture: Image, photograph: Image) -> Image:
    """Derivative of `loss` with respect to each pixel of `picture`, Eq. (2): (H, W), float64."""
    # >>> solution 00.1
    return 2.0 * (picture - photograph) / picture.size
    # <<< solution
