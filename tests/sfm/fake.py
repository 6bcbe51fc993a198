"""Photographs of a sphere, and an engine that knows where they were taken from."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import numpy as np
from photograd.capture.sfm.engine import Reconstructed, Settings

from support import capture_files as files

CAMERAS = files.orbit(9)


class FakeEngine:
    """Places photographs by their rank; notes what it was asked for, and stops where it is told."""

    def __init__(self, placed: Sequence[int] = (9,)) -> None:
        """`placed`: photographs that each attempt at a map places, one after another."""
        self.placed = list(placed)
        self.calls: list[str] = []
        self.interrupt = ""
        self.groups: list[list[str]] = []
        self.known: set[str] = set()
        self.compared: set[tuple[str, str]] = set()
        self.agreeing: list[int] = []

    def __call__(self, _out: Path, photographs: Path, _s: Settings, _threads: int) -> FakeEngine:
        """The door: this engine itself."""
        self.photographs = photographs
        return self

    def _called(self, stage: str) -> None:
        self.calls.append(stage)
        if self.interrupt == stage and self.calls.count(stage) == 2:
            raise KeyboardInterrupt

    def enter(self, groups: Sequence[Sequence[str]]) -> None:
        self.groups = [list(group) for group in groups]

    def extracted(self) -> set[str]:
        return set(self.known)

    def extract(self, names: Sequence[str]) -> None:
        self._called("extract")
        assert all((self.photographs / name).is_file() for name in names)
        self.known |= set(names)

    def pending(self, pairs: Iterable[tuple[str, str]]) -> list[tuple[str, str]]:
        return [pair for pair in pairs if pair not in self.compared]

    def match(self, pairs: Sequence[tuple[str, str]]) -> None:
        self._called("match")
        self.compared |= set(pairs)

    def map(
        self, folder: Path, agreeing: int, on_photograph: Callable[[], None]
    ) -> list[Reconstructed]:
        self._called("map")
        self.agreeing.append(agreeing)
        count = self.placed.pop(0)
        names = sorted(path.name for path in self.photographs.iterdir())[:count]
        for _ in names:
            on_photograph()
        if not names:
            return []
        shutil.rmtree(folder, ignore_errors=True)
        points = files.sphere_points()
        files.write_colmap_binary(folder / "0", CAMERAS[:count], names, points)
        return [Reconstructed(tuple(names), len(points), 0.25)]


def photographs(folder: Path) -> Path:
    """Nine of them."""
    files.write_pictures(folder, CAMERAS, alpha=False)
    return folder


def similarity(source: np.ndarray, target: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Scale, rotation (3, 3) and translation (3,) that bring source (N, 3) nearest to target.

    The least-squares solution, through the singular values of the covariance.
    """
    here, there = source.mean(axis=0), target.mean(axis=0)
    a, b = source - here, target - there
    u, s, v = np.linalg.svd(b.T @ a)
    flip = np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ v))])
    rotation = u @ flip @ v
    scale = float((s * np.diag(flip)).sum() / np.square(a).sum())
    return scale, rotation, there - scale * rotation @ here
