"""Scene representations, one a file. Importing this package registers them all."""

from __future__ import annotations

from photograd.fields.dense_grid import DenseGrid
from photograd.fields.tiny_network import TinyNetwork

__all__ = ["DenseGrid", "TinyNetwork"]
