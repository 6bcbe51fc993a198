"""`photograd fit --degree` and `--prune`: what they do, and where they are refused."""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Any

import pytest
from photograd._checkpoint import load_checkpoint
from photograd.commands.fit import fit
from photograd.fields import fittable
from photograd.fitting import FitOptions, options_for
from photograd.fitting.compare import Candidate

from tests.commands.conftest import Photograd
from tests.commands.test_bad_input import FEW, assert_one_line


def test_harmonics_and_pruning_are_options_of_a_fit(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    few = ("--representation", "sparse_sh", "--steps", 24, "--resolution", 16, "--rays", 256)
    for name, words in {"all": ("--prune", 0), "few": ("--prune", 0.01, "--degree", 0)}.items():
        assert photograd("fit", capture_folder, "--out", tmp_path / name, *few, *words).code == 0
    every, some = (load_checkpoint(tmp_path / name) for name in ("all", "few"))
    assert every.params["sh"].shape[1:] == (9, 3)
    assert some.params["sh"].shape[1:] == (1, 3)
    assert len(some.params["density"]) < len(every.params["density"]) == 16 * 12 * 14
    assert (every.meta["options"]["degree"], some.meta["options"]["degree"]) == (2, 0)
    done = photograd("fit", capture_folder, "--out", tmp_path / "few", "--resume", "--prune", 0.2)
    assert_one_line(done, "--prune: expected 0.01, which the checkpoint was started with")


def test_each_representation_has_the_resolution_that_suits_it(photograd: Photograd) -> None:
    """A candidate keeps the size that it is called by."""
    assert options_for("sparse_sh").resolution == 256
    assert options_for("sparse_sh", resolution=40).resolution == 40
    assert options_for("dense_grid").resolution == 128
    assert Candidate("sparse_sh", 128).options(FitOptions()).resolution == 128
    shown = photograd("fit", "--help").out
    text = " ".join(shown.replace("│", " ").split())
    assert "128; hash_grid: 512, mesh: 16, nerf: 64, plenoctree: 192, sparse_sh: 256" in text
    assert "0.02; plenoctree: 0.01" in text


def test_a_default_of_the_command_line_hides_none_of_a_representation() -> None:
    own = {name for kind in fittable().values() for name in kind.fit_defaults}
    parameters = inspect.signature(fit).parameters
    assert {"prune", "resolution", "steps"} <= own
    assert {name: parameters[name].default for name in own} == dict.fromkeys(own)


@pytest.mark.parametrize(
    ("representation", "words", "says"),
    [
        (
            "dense_grid",
            ("--degree", 1),
            "--degree: expected a fit of dense_sh or gaussians or octree_sh or plenoctree",
        ),
        ("dense_sh", ("--prune", 0.1), "fit of plenoctree or sparse_sh, got 'dense_sh'"),
    ],
)
def test_options_without_effect_are_refused(
    photograd: Photograd,
    capture_folder: Path,
    tmp_path: Path,
    representation: str,
    words: Any,
    says: str,
) -> None:
    kind = ("--representation", representation)
    done = photograd("fit", capture_folder, "--out", tmp_path, *kind, *words, *FEW)
    assert_one_line(done, says, "leave it out")
    assert not (tmp_path / "model.npz").exists()


def test_a_degree_that_there_is_not(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    done = photograd("fit", capture_folder, "--out", tmp_path, "--degree", 4, *FEW)
    assert done.code == 2
    assert "Invalid value for '--degree'" in done.err
    assert "3" in done.err
