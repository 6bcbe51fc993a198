"""The array types of annotations; docstrings and comments give shapes and axes."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[Any]
"""An array whose dtype its docstring gives, mostly float32 or float64."""

FloatArray: TypeAlias = NDArray[np.float64]
"""An array of double precision."""
