"""The benchmarks run, do the work they say, and refuse to compare what is not comparable."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from support.tree import ROOT

BENCH = ROOT / "bench"
FIELDS = {
    "workload",
    "peer",
    "version",
    "size",
    "threads",
    "seconds_fwd",
    "seconds_fwdbwd",
    "quality",
    "peak_rss_mb",
    "timings_fwd",
    "timings_fwdbwd",
    "loadavg",
    "machine",
    "bound",
    "inputs",
}
TIMING = {"median", "min", "all", "foreign", "cpu_median", "first", "tries"}
TINY_W4 = {"n": 16, "res": 8, "views": 1}
Array = NDArray[Any]
Row = dict[str, Any]

pytestmark = pytest.mark.usefixtures("core")


def call(script: str, *words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(BENCH / script), *words]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def one_row(script: str, *words: str) -> Row:
    done = call(script, *words)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("\n") == 1
    row: Row = json.loads(done.stdout)
    return row


def module(name: str) -> ModuleType:
    """A module that lies beside the scripts."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(BENCH))
        return import_module(name)


@pytest.fixture(scope="module")
def w4_row() -> Row:
    sizes = [word for name, value in TINY_W4.items() for word in (f"--{name}", str(value))]
    return one_row("w4_volume.py", *sizes, "--reps", "1", "--breakdown")


def test_w4_prints_one_line_with_all_fields(w4_row: Row) -> None:
    assert set(w4_row) == FIELDS | {"breakdown"}
    assert w4_row["workload"] == "W4"
    assert w4_row["peer"] == "photograd"
    for seconds, timing in (("seconds_fwd", "timings_fwd"), ("seconds_fwdbwd", "timings_fwdbwd")):
        assert set(w4_row[timing]) == TIMING
        assert w4_row[seconds] == w4_row[timing]["median"] > w4_row["bound"][seconds] > 0
        assert len(w4_row[timing]["all"]) == len(w4_row[timing]["foreign"]) == 1
    assert {"reverse", "forward", "loss", "clear", "backward"} < set(w4_row["breakdown"])


def lookup(grid: Array, points: Array) -> tuple[Array, list[tuple[Array, Array]]]:
    """Values (..., 4) at points (..., 3) x y z, and the eight (voxel, weight) behind each."""
    n = len(grid)
    q = np.clip((points[..., ::-1] + 1) * n / 2 - 0.5, 0, n - 1)  # z y x
    low = np.minimum(q.astype(int), n - 2)
    part = q - low
    corners = []
    for bits in np.ndindex(2, 2, 2):
        z, y, x = np.moveaxis(low + bits, -1, 0)
        weight = np.where(bits, part, 1 - part).prod(axis=-1)
        corners.append(((z * n + y) * n + x, weight))
    flat = grid.reshape(-1, 4).astype(np.float64)
    return sum(w[..., None] * flat[i] for i, w in corners), corners


def reference(grid: Array, rays: tuple[Array, Array], target: Array | None) -> Row:
    """The workload as it is written down, all samples of all rays at once, in double precision."""
    o, d = rays
    n = len(grid)
    with np.errstate(divide="ignore"):
        a, b = (-1 - o) / d, (1 - o) / d
    near = np.maximum(np.minimum(a, b).max(axis=1), np.float32(0))
    far = np.maximum(np.maximum(a, b).min(axis=1), near)
    count = np.floor((far - near) / np.float32(1 / n)).astype(int)
    k = np.arange(count.max())
    inside = k < count[:, None]
    t = near[:, None].astype(np.float64) + (k + 0.5) / n
    value, corners = lookup(grid, o[:, None] + t[..., None] * d[:, None].astype(np.float64))
    tau = np.where(inside, value[..., 3], 0) / n
    before = np.exp(-(np.cumsum(tau, axis=1) - tau))  # transmittance in front of each sample
    light = (before * tau)[..., None] * value[..., :3]
    image = light.sum(axis=1)
    row: Row = {"image": image, "samples": int(count.sum())}
    if target is None:
        return row
    d_image = (image - target) * (2 / image.size)
    behind = image[:, None] - np.cumsum(light, axis=1)
    d_value = np.empty_like(value)
    d_value[..., :3] = (before * tau)[..., None] * d_image[:, None]
    d_tau = before[..., None] * value[..., :3] - behind
    d_value[..., 3] = np.where(inside, (d_tau * d_image[:, None]).sum(axis=-1) / n, 0)
    d_grid = np.zeros((n**3, 4))
    for index, weight in corners:
        np.add.at(d_grid, index, weight[..., None] * d_value)
    row["loss"] = float(np.square(image - target).mean())
    return row | {"d_grid": d_grid.reshape(grid.shape)}


def test_w4_computes_the_workload(w4_row: Row) -> None:
    inputs = module("_inputs")
    rays = inputs.orbit_rays(TINY_W4["res"], TINY_W4["views"])
    grid, other = (inputs.volume_grid(TINY_W4["n"], phase) for phase in (0.0, 0.6))
    target = reference(other, rays, None)["image"]
    truth = reference(grid, rays, target)
    d_grid = truth["d_grid"]
    # The reference itself, by a central difference along a direction that touches every voxel.
    step = 1e-4 * np.random.default_rng(5).standard_normal(grid.shape)
    ends = [reference(grid + sign * step, rays, target)["loss"] for sign in (1, -1)]
    slope = float((d_grid * step).sum())
    assert slope != 0
    assert (ends[0] - ends[1]) / 2 == pytest.approx(
        slope, rel=1e-6
    )  # cubic terms in a step of 1e-4

    expected = {
        "image_mean": truth["image"].mean(),
        "loss": truth["loss"],
        "grad_norm_rgb": np.linalg.norm(d_grid[..., :3]),
        "grad_norm_sigma": np.linalg.norm(d_grid[..., 3]),
    }
    assert min(expected.values()) > 1e-5
    # float32 arithmetic along 30 samples: the figures differ by about 1e-7.
    assert w4_row["quality"] == pytest.approx(expected, rel=1e-5)
    assert w4_row["size"] == {"n": 16, "rays": 64, "samples": truth["samples"]}


def test_w1_prints_one_line_or_says_that_meshes_are_missing() -> None:
    try:
        import photograd.geometry.mesh  # noqa: F401
    except ImportError:
        done = call("w1_rays.py")
        assert (done.returncode, done.stdout) == (2, "")
        assert "cannot trace meshes" in done.stderr
        return
    row = one_row("w1_rays.py", "--nv", "12", "--res", "8", "--reps", "1")
    assert set(row) == FIELDS | {"build_seconds"}
    assert row["size"] == {"triangles": 528, "rays": [64, 64]}
    for name in ("primary", "bounce"):
        assert row["quality"][name]["hits"] == 64  # all rays start inside of a closed mesh
        assert set(row["timings_fwd"]["parts"][name]) == TIMING
        # The radius lies between 0.88 and 1.12; a chord is no longer than twice that.
        assert 0.1 < row["quality"][name]["mean_t"] < 2.24


def peer_row(row: Row, **changes: Any) -> Row:
    """What another program might have printed about the same workload: four times as slow."""
    slow = {name: 4 * row[name] for name in ("seconds_fwd", "seconds_fwdbwd")}
    return {**row, "peer": "numba", **slow, **changes}


def compared(tmp_path: Path, row: Row, *words: str) -> tuple[Row, str]:
    """The comparison with a peer whose script prints `row`, and the table."""
    (tmp_path / "w4_volume_numba.py").write_text(f"print({json.dumps(row)!r})\n", encoding="utf-8")
    sizes = [word for name, value in TINY_W4.items() for word in ("--set", f"{name}={value}")]
    python = f"numba={sys.executable}"
    done = call(
        "compare.py",
        "w4",
        "--reps",
        "1",
        *sizes,
        "--peers",
        str(tmp_path),
        "--python",
        python,
        *words,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1]), done.stderr


def test_compare_prints_the_ratio_of_equal_work(tmp_path: Path, w4_row: Row) -> None:
    busy = {**w4_row["timings_fwd"], "foreign": [0.9, 0.9]}
    line, table = compared(tmp_path, peer_row(w4_row, timings_fwd=busy), "--rounds", "2")
    assert (line["compare"], line["peer"], line["valid"]) == ("W4", "numba", True)
    time = line["times"]["seconds_fwd"]
    assert time["theirs"] == 4 * w4_row["seconds_fwd"]
    assert time["ratio"] == time["theirs"] / time["ours"] > 0
    assert "!" in table.split("numba")[1].splitlines()[0]  # others were at work
    assert "INVALID" not in table


@pytest.mark.parametrize(
    ("where", "name", "factor"),
    [("quality", "loss", 1.002), ("quality", "loss", math.nan), ("size", "samples", 2)],
)
def test_compare_refuses_a_doctored_row(
    tmp_path: Path, w4_row: Row, where: str, name: str, factor: float
) -> None:
    doctored = w4_row[where] | {name: w4_row[where][name] * factor}
    line, table = compared(tmp_path, peer_row(w4_row, **{where: doctored}))
    assert not line["valid"]
    assert [reason for reason in line["why"] if name in reason]
    assert {time["ratio"] for time in line["times"].values()} == {"INVALID"}
    assert table.split("numba")[1].splitlines()[0].count("INVALID") == 2


def test_four_digits_are_what_must_agree() -> None:
    agree = module("_agreement").agree
    assert agree(9.71212e-06, 9.71249e-06)
    assert not agree(9.712e-06, 9.718e-06)
    assert agree(0.0, 0.0)
    assert not agree(0.0, 1e-9)
    assert not agree(1.0, -1.0)


def test_table_fills_the_page(tmp_path: Path, w4_row: Row) -> None:
    rows = [w4_row, peer_row(w4_row), peer_row(w4_row, peer="other", quality={"loss": 1.0})]
    file = tmp_path / "run.jsonl"
    file.write_text("".join(json.dumps(row) + "\n" for row in rows), encoding="utf-8")
    done = call("table.py", str(file))
    assert done.returncode == 0, done.stderr
    lines = {line.split("|")[1].strip(): line for line in done.stdout.splitlines() if "|" in line}
    version = w4_row["version"]
    assert lines[f"numba {version}"].count(" 4.00 ") == 2
    assert lines[f"other {version}"].count("INVALID") == 2
    assert "reverse" in lines
    assert "times that" in done.stdout
