"""Runs our benchmarks and other programs' in turns, and prints ratios of medians.

    python bench/compare.py [w1 w4_volume ...] [--peers DIR --python NAME=INTERPRETER ...]
                            [--results FILE] [--rounds N] [--set n=64 ...]

DIR holds the peers' scripts (PEERS below), each of which prints one JSON line with the fields of
_common.report. What was measured goes to standard output as JSON lines, a table to standard error.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from _runs import BUSY, Row, Runs, comparison, group, read_rows
from rich.console import Console
from rich.markup import escape
from rich.table import Table

HERE = Path(__file__).resolve().parent


@dataclass(frozen=True)
class Peer:
    """Another program's script for a workload, and which of the given interpreters runs it.

    `words` are more arguments for it.
    """

    workload: str
    name: str
    script: str
    environment: str
    words: tuple[str, ...] = ()


PEERS = [
    Peer("W1", "mitsuba-llvm", "w1_rays_mitsuba.py", "mi"),
    Peer("W1", "embreex", "w1_rays_embreex.py", "ray"),
    Peer("W1", "open3d", "w1_rays_open3d.py", "o3d"),
    Peer("W2", "mitsuba-llvm", "w2_path_mitsuba.py", "mi", ("--rr-depth", "5")),
    Peer(
        "W2",
        "mitsuba-scalar",
        "w2_path_mitsuba.py",
        "mi",
        ("--rr-depth", "5", "--variant", "scalar_rgb"),
    ),
    Peer(
        "W3", "mitsuba-llvm-prb", "w3_adjoint_mitsuba.py", "mi", ("--rr-depth", "5", "--spp", "32")
    ),
    Peer("W4", "numba", "w4_volume_numba.py", "numba"),
    Peer("W4", "drjit-llvm", "w4_volume_drjit.py", "mi"),
    Peer("W4", "taichi", "w4_volume_taichi.py", "ti"),
    Peer("W4", "torch", "w4_volume_torch.py", "torch"),
    Peer("W4", "jax", "w4_volume_jax.py", "jax"),
    Peer("W5", "numba", "w5_texture_numba.py", "numba"),
    Peer("W5", "drjit-llvm", "w5_texture_drjit.py", "mi"),
    Peer("W5", "torch", "w5_texture_torch.py", "torch"),
    Peer("W5", "jax", "w5_texture_jax.py", "jax"),
    Peer("W6a", "torch", "w6_sh_torch.py", "torch"),
    Peer("W6b", "taichi", "w6_plenoxel_taichi.py", "ti"),
    Peer("W6b", "torch", "w6_plenoxel_torch.py", "torch"),
    Peer("W7a", "jax", "w7_hash_jax.py", "jax"),
    Peer("W7a", "torch", "w7_hash_torch.py", "torch"),
    Peer("W7b", "torch", "w7_nerf_torch.py", "torch"),
    Peer("W8", "torch-tiles", "w8_splat_torch.py", "torch"),
    Peer("W9", "mitsuba-llvm-direct_projective", "w9_raster_mitsuba.py", "mi"),
    Peer("W9-forward", "pyrender-osmesa", "w9_raster_pyrender.py", "gl"),
    Peer("W10", "mitsuba-llvm", "w10_bsdf_mitsuba.py", "mi"),
    Peer("W10", "torch", "w10_bsdf_torch.py", "torch"),
    Peer("W10", "torch-compile", "w10_bsdf_torch.py", "torch", ("--compile", "1")),
]
VARIANTS: dict[str, list[tuple[str, ...]]] = {
    "w2_path": [("--sphere", ball) for ball in ("principled", "simple")],
    "w3_adjoint": [("--sphere", ball) for ball in ("principled", "simple")],
    "w10_bsdf": [("--params", kind) for kind in ("scalar", "texture")],
}
"""Arguments with which a workload is measured, all programs alike; once without any by default."""
REFERENCES = {"w2_path": "w2_{}.npy", "w3_adjoint": "w3_{}"}
"""Files in the folder `reference` beside the peers' scripts, by the variant's last word."""


def emit(row: Mapping[str, Any]) -> None:
    sys.stdout.write(json.dumps(row) + "\n")
    sys.stdout.flush()


def run(runs: Runs, command: list[str], folder: Path, number: int, timeout: float) -> None:
    """Run a script, keep and print its row; or remember why there is none, and do not try again."""
    if runs.error:
        return
    try:
        done = subprocess.run(
            command, cwd=folder, capture_output=True, text=True, check=False, timeout=timeout
        )
    except (OSError, subprocess.TimeoutExpired) as failure:
        runs.error = str(failure)
        return
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    if done.returncode != 0 or not lines:
        runs.error = (done.stderr.strip().splitlines() or ["printed nothing"])[-1]
        return
    row = json.loads(lines[-1]) | {"round": number}
    runs.rows.append(row)
    emit(row)


def variants_of(script: Path, args: argparse.Namespace) -> list[list[str]]:
    """Arguments of each variant of a workload; one list without any where there are none.

    What --set names is not varied.
    """
    named = {pair.split("=", 1)[0] for pair in args.set}
    found: list[list[str]] = []
    for words in VARIANTS.get(script.stem, [()]):
        mine = [] if words and words[0].removeprefix("--") in named else list(words)
        if mine and args.peers and script.stem in REFERENCES and "reference" not in named:
            file = args.peers.resolve() / "reference" / REFERENCES[script.stem].format(mine[-1])
            if list(file.parent.glob(f"{file.name}*")):
                mine += ["--reference", str(file)]
        if mine not in found:
            found.append(mine)
    return found


def measure(
    workload: str, script: Path, args: argparse.Namespace, variant: list[str]
) -> tuple[Runs, list[Runs]]:
    """Our program and the others, one after another, as often as there are rounds."""
    words = ["--reps", str(args.reps), *variant]
    words += ["--threads", str(args.threads)] if args.threads else []
    for pair in args.set:
        name, value = pair.split("=", 1)
        words += [f"--{name}", value]
    ours = Runs(workload, "photograd")
    others = [
        (
            Runs(workload, peer.name),
            [args.pythons[peer.environment], peer.script, *words, *peer.words],
        )
        for peer in PEERS
        if args.peers and peer.workload == workload and peer.environment in args.pythons
    ]
    for number in range(args.rounds):
        run(ours, [sys.executable, script.name, *words], HERE, number, args.timeout)
        for runs, command in others:
            run(runs, command, args.peers, number, args.timeout)
    return ours, [runs for runs, _ in others]


def seconds_cell(seconds: float | None, foreign: float) -> str:
    if seconds is None:
        return "-"
    return f"{seconds:.4g}" + (" [yellow]![/]" if foreign > BUSY else "")


def ratio_cell(ratio: float | str) -> str:
    return f"[red]{ratio}[/]" if isinstance(ratio, str) else f"{ratio:.2f}"


def add_ours(table: Table, ours: Runs) -> None:
    """Seconds, and how many times longer that is than the machine's own limit."""
    bound = ours.rows[0].get("bound", {})
    cells, far = [], []
    for key in ("seconds_fwd", "seconds_fwdbwd"):
        seconds = ours.seconds(key)
        cells += [seconds_cell(seconds, ours.foreign()), ""]
        far.append(f"{seconds / bound[key]:.1f}" if seconds and bound.get(key) else "-")
    table.add_row(ours.workload, ours.name, *cells, " / ".join(far), f"{ours.foreign():.2f}")


def add_theirs(table: Table, line: Row) -> None:
    """A row for another program, and one for each part of the time that both report."""
    name, (mine, threads) = line["peer"], line["threads"]
    name += "" if line["same_run"] else ", another run"
    name += "" if threads == mine else f", {threads} thread{'s' * (threads != 1)}"
    load = line["foreign"][1]

    def cells(key: str) -> list[str]:
        if key not in line["times"]:
            return ["-", "-"]
        time = line["times"][key]
        return [seconds_cell(time["theirs"], load), ratio_cell(time["ratio"])]

    both = cells("seconds_fwd") + cells("seconds_fwdbwd")
    table.add_row("", name, *both, "", f"{load:.2f}")
    for key in line["times"]:
        if not key.startswith("seconds"):
            table.add_row("", f"  {key}", *cells(key), "", "", "", "")


def compare(
    script: Path, args: argparse.Namespace, table: Table, notes: list[str], variant: list[str]
) -> bool:
    """Measure one workload and add it to the table; False if our own script failed."""
    workload = script.stem.split("_")[0].replace("w", "W", 1)  # "w6a_sh" measures W6a
    ours, others = measure(workload, script, args, variant)
    if args.results:
        rows = read_rows(args.results)
        if variant:
            rows = [row for row in rows if variant[1] in row.get("size", {}).values()]
        others += group(rows, workload, same_run=False)
    notes += [f"{workload} {runs.name}: {runs.error}" for runs in (ours, *others) if runs.error]
    if not ours.rows:
        return False
    add_ours(table, ours)
    if ours.rows[0].get("inputs", {}).get("agree") is False:
        notes.append(f"{workload}: the inputs are not those on record (_inputs.py)")
    for runs in others:
        if runs.rows:
            line = comparison(ours, runs)
            emit(line)
            add_theirs(table, line)
            if line["why"]:
                notes.append(f"{workload} {runs.name}: INVALID: {'; '.join(line['why'])}")
    return ours.error is None


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Ratios of medians, measured in one run")
    parser.add_argument("names", nargs="*", help="workloads, such as w4 or w4_volume; default all")
    parser.add_argument("--peers", type=Path, help="folder of the peers' scripts")
    parser.add_argument("--python", action="append", default=[], metavar="NAME=INTERPRETER")
    parser.add_argument("--results", type=Path, help="rows that were measured in another run")
    parser.add_argument("--rounds", type=int, default=1, help="turns that every program gets")
    parser.add_argument("--reps", type=int, default=3)
    parser.add_argument("--threads", type=int, default=0, help="default: all processors")
    parser.add_argument("--set", action="append", default=[], metavar="SIZE=NUMBER")
    parser.add_argument("--timeout", type=float, default=900.0, help="seconds for one script")
    args = parser.parse_args()
    if not all("=" in pair for pair in args.python + args.set):
        parser.error("--python and --set want NAME=VALUE")
    args.pythons = dict(pair.split("=", 1) for pair in args.python)
    return args


def main() -> int:
    args = parse()
    scripts = {path.stem: path for path in sorted(HERE.glob("w*.py"))}
    known = {name for stem in scripts for name in (stem, stem.split("_")[0])}
    unknown = [name for name in args.names if name not in known]
    if unknown:
        sys.stderr.write(f"compare: names: expected some of {sorted(known)}, got {unknown}\n")
        return 2
    table = Table("workload", "program", "fwd s", "x", "fwd+bwd s", "x", "x bound", "load")
    notes: list[str] = []
    good = [
        compare(path, args, table, notes, variant)
        for stem, path in scripts.items()
        if not args.names or {stem, stem.split("_")[0]} & set(args.names)
        for variant in variants_of(path, args)
    ]
    console = Console(stderr=True, width=None if sys.stderr.isatty() else 120)
    console.print(table)
    console.print("x: times as long as photograd takes; x bound: times as long as the bound")
    console.print(f"!: other processes used more than {BUSY} cores, too much to be quoted")
    for note in notes:
        console.print(escape(note))
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
