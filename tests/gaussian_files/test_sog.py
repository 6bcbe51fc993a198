"""Gaussians as .sog: read back by a decoder of our own, written from what the files say.

SplatTransform 2.7.1 of PlayCanvas reads the same numbers out of them, to the bit (opacities of 0
and 1 it moves by 1e-6): of biker.ply with 152,746 Gaussians, and of a cloud with degree 3.
"""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import IoError
from photograd.splats.coding import differences, opacity_of, unit_quats
from photograd.splats.files import codings_of, reread, write_gaussians
from photograd.splats.frames import Presentation
from photograd.splats.palette import palette_of, table_of
from photograd.splats.sog_files import sorted_gaussians
from photograd.splats.splatting import Gaussians
from PIL import Image

from tests.splat import oracle

COUNT = 3000


def scene(degree: int) -> Gaussians:
    return oracle.cloud(COUNT, 1, degree=degree, spread=5.0).astype(np.float32)


def content(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """meta.json, and the pixels of each image, by a reader that knows none of ours."""
    with zipfile.ZipFile(path) as archive:
        meta = json.loads(archive.read("meta.json"))
        names = [name for name in archive.namelist() if name.endswith(".webp")]
        pictures = {name: np.asarray(Image.open(io.BytesIO(archive.read(name)))) for name in names}
    return meta, pictures


@pytest.mark.parametrize("degree", [0, 1, 3])
def test_what_the_file_says_is_what_was_written(tmp_path: Path, degree: int) -> None:
    g, path = sorted_gaussians(scene(degree)), tmp_path / "a.sog"
    write_gaussians(path, scene(degree), presentation=Presentation(antialiased=True))
    meta, images = content(path)
    assert (meta["version"], meta["count"], meta["antialias"]) == (2, COUNT, True)
    flat = {name: image.reshape(-1, image.shape[2])[:COUNT] for name, image in images.items()}
    for k in range(3):  # one axis after another, as a program would read them
        low, high = flat["means_l.webp"][:, k], flat["means_u.webp"][:, k]
        share = (low.astype(int) | high.astype(int) << 8) / 65535
        n = meta["means"]["mins"][k] * (1 - share) + meta["means"]["maxs"][k] * share
        x = np.sign(n) * (np.exp(np.abs(n)) - 1)
        assert np.abs(x - g.means[:, k]).max() < 1e-3
        scale = np.array(meta["scales"]["codebook"])[flat["scales.webp"][:, k]]
        assert np.abs(scale - g.log_scales[:, k]).max() < 0.05
        color = np.array(meta["sh0"]["codebook"])[flat["sh0.webp"][:, k]]
        assert np.abs(color - g.sh[:, 0, k]).max() < 0.05
    alpha = flat["sh0.webp"][:, 3] / 255
    assert np.abs(alpha - opacity_of(g.opacity_logits)).max() < 0.51 / 255
    q = unit_quats(g.quats)
    for row, stored in zip(q[:200], flat["quats.webp"][:200].astype(float), strict=True):
        largest = int(stored[3]) - 252
        rest = iter((stored[:3] / 255 - 0.5) * 2 / np.sqrt(2))
        found = [0.0 if k == largest else next(rest) for k in range(4)]
        found[largest] = np.sqrt(1 - np.square(found).sum())
        assert min(np.abs(row - found).max(), np.abs(row + found).max()) < 0.01
    if degree:
        bands = meta["shN"]["bands"]
        per_entry = (bands + 1) ** 2 - 1
        palette = images["shN_centroids.webp"]
        assert palette.shape[1] == 64 * per_entry
        label = flat["shN_labels.webp"][:, 0] + 256 * flat["shN_labels.webp"][:, 1].astype(int)
        for i in (0, 17, COUNT - 1):
            entry = palette[label[i] // 64, (label[i] % 64) * per_entry :][:per_entry]
            values = np.array(meta["shN"]["codebook"])[entry]
            assert np.abs(values - g.sh[i, 1:]).max() < 0.05
    else:
        assert "shN" not in meta


@pytest.mark.parametrize("degree", [0, 3])
def test_what_is_reported_is_within_the_bounds(tmp_path: Path, degree: int) -> None:
    g, path = scene(degree), tmp_path / "a.sog"
    write_gaussians(path, g)
    ordered, after = reread(path, g)
    for each in differences(ordered, after.gaussians, codings_of(path, g)):
        assert 0 < each.largest <= each.bound, each
        assert each.largest > 0.2 * each.bound, each
    first = path.read_bytes()
    write_gaussians(path, g)
    assert path.read_bytes() == first
    with pytest.raises(IoError, match="at least one, got 0"):
        write_gaussians(path, Gaussians(**{k: a[:0] for k, a in g.arrays().items()}))


def test_tables_keep_the_extremes_and_spend_entries_where_values_are() -> None:
    random = np.random.default_rng(1)
    values = np.concatenate([random.normal(0, 0.1, 5000), [-8.0, 9.0]])
    table, nearest = table_of(values)
    error = np.abs(table[nearest] - values)
    assert (np.diff(table) >= 0).all()
    assert error.max() <= 0.5 * np.diff(table).max() + 1e-12
    assert error[-2:].max() == 0
    even = np.linspace(-8, 9, 256)
    # Measured 0.45: most entries are where most values are, the others keep rare ones apart.
    assert error.mean() < 0.5 * np.abs(values[:, None] - even).min(axis=1).mean()
    assert table_of(np.full(5, 2.5))[0].tolist() == [2.5] * 256


def test_a_palette_stands_for_more_rows_than_it_has() -> None:
    random = np.random.default_rng(2)
    centers = random.normal(0, 1, (8, 6))
    rows = centers[np.arange(4096) % 8] + random.normal(0, 0.01, (4096, 6))
    palette, label = palette_of(rows, 64)
    assert palette.shape == (64, 6)
    assert np.bincount(label).tolist() == [64] * 64
    # The eight clusters are told apart: what is left is their own spread.
    assert np.abs(palette[label] - rows).max() < 0.1
    few, own = palette_of(rows[:10], 64)
    assert np.array_equal(few[own], rows[:10])
