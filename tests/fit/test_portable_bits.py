"""A fit ends with the same bits whatever instructions NumPy, BLAS, the C library and we may use."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
from numpy._core import _multiarray_umath as umath
from photograd.capture.write import write_blender_capture
from PIL import Image

from tests.fit import scene
from tests.fit.all_fits import digests

ROOT = Path(__file__).resolve().parents[2]
PLAIN_LIBM = "glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4,-AVX2_Usable,-FMA_Usable,-AVX512F,-AVX512VL"


def opaque_capture(folder: Path) -> Path:
    """Photographs without alpha in front of a wall, without a box: that is estimated, too."""
    frames = [
        (name, camera, scene.over_wall(image, (0.9, 0.6, 0.3)), None)
        for name, camera, image in scene.frames()["train"]
    ]
    write_blender_capture(folder, {"train": frames})
    for path in folder.rglob("*.png"):
        Image.open(path).convert("RGB").save(path)
    return folder


def test_the_same_bits_without_any_instruction_that_can_be_switched_off(tmp_path: Path) -> None:
    features = [name for name in umath.__cpu_dispatch__ if umath.__cpu_features__[name]]
    variables = {
        "NPY_DISABLE_CPU_FEATURES": " ".join(features),
        "GLIBC_TUNABLES": PLAIN_LIBM,
        "PHOTOGRAD_ISA": "baseline",
    }
    if "X86_V2" in umath.__cpu_baseline__:
        variables["OPENBLAS_CORETYPE"] = "Nehalem"
    folder = opaque_capture(tmp_path / "capture")
    other = subprocess.run(
        [sys.executable, "-m", "tests.fit.all_fits", str(folder)],
        cwd=ROOT,
        env=os.environ | variables,
        capture_output=True,
        text=True,
        check=True,
    )
    plain, bare = digests(folder), json.loads(other.stdout)
    same = plain.pop("of the processor") == bare.pop("of the processor")
    assert same != ("X86_V3" in features)  # the switches do something
    assert plain == bare
    assert np.unique(list(plain.values())).size == len(plain)
