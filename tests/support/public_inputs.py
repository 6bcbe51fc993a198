"""Small inputs for calls of public functions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from photograd import capture
from photograd.geometry.mesh import Mesh

Call = tuple[Callable[..., Any], dict[str, Any]]
H, W = 6, 8
RNG = np.random.default_rng(5)
COLOR = RNG.random((H, W, 3))
DEPTH = 1 + RNG.random((H, W))
NORMALS = np.broadcast_to([0.0, 0.0, -1.0], (H, W, 3)).copy()
CAMERA = capture.Camera(W, H, 8.0, 8.0, 4.0, 3.0, np.eye(4))
CORNERS = np.array([[0, 0, 2.0], [1, 0, 2], [0, 1, 2], [1, 1, 2.5]])
FACES = np.array([[0, 1, 2], [1, 3, 2]], np.uint32)
MESH = Mesh(CORNERS, FACES)
POINTS = RNG.random((5, 3))
BOX = np.array([[0.0, 0, 0], [1, 1, 1]])
