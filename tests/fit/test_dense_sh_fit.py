"""A dense grid of harmonics fitted from photographs: it resumes, and it is never pruned."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from photograd._checkpoint import load_checkpoint
from photograd.fields import DenseSh
from photograd.fitting.loop import Fit
from photograd.fitting.model import load_model

from tests.fit import scene
from tests.fit.test_resume import assert_same, run

OPTIONS = {"resolution": 16, "steps": 24, "rays": 256, "representation": "dense_sh", "degree": 1}


def test_it_is_resumed_to_the_bit_and_keeps_all_voxels(tmp_path: Path) -> None:
    capture = scene.capture()
    run(Fit.start(capture, scene.options(**OPTIONS)), tmp_path / "straight")
    run(Fit.start(capture, scene.options(**OPTIONS)), tmp_path / "stopped", until=5)
    resumed = Fit.resume(capture, tmp_path / "stopped")
    assert isinstance(resumed.model, DenseSh)
    run(resumed, tmp_path / "stopped")
    assert_same(tmp_path / "straight", tmp_path / "stopped")
    field = load_model(tmp_path / "straight").field
    assert isinstance(field, DenseSh)
    assert field.resolution == 16
    assert field.active.mask.all()  # past the step at which a sparse grid is pruned
    assert np.abs(field.params["sh"][:, 1:]).max() > 0.1
    history = load_checkpoint(tmp_path / "straight").history
    assert history[-5:, 1].mean() < 0.8 * history[:5, 1].mean()  # measured: 0.60
