"""Files of regular volumes, as scanners and simulations write them; see `read_volume`."""

from __future__ import annotations

from photograd.grids.volumes.read import SUFFIXES, read_volume
from photograd.grids.volumes.volume import Volume

__all__ = ["SUFFIXES", "Volume", "read_volume"]
