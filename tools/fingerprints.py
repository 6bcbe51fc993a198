"""Hashes of everything that the renderers compute, to prove that a rewrite keeps every bit.

`write` computes about 1,700 small results (pictures, gradients, tangents, samples, densities) and
writes a line "name sha256" for each; `compare` computes them again and lists those that differ.
The hashes are those of one machine: its NumPy makes the inputs.

Where bits are meant to change, `write --save FOLDER` keeps the arrays themselves, and
`compare --against FOLDER` says by how much they differ. Pictures and gradients get a z-test as
well, between the means of several seeds before and after.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from fingerprint_cases.catalog import selected
from fingerprint_cases.compare import compare, describe_difference
from fingerprint_cases.run import FAILED, compute_all, save_seeds


def parser() -> argparse.ArgumentParser:
    """The command line."""
    made = argparse.ArgumentParser(
        prog="fingerprints.py",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    commands = made.add_subparsers(dest="command", required=True)
    write = commands.add_parser("write", help="compute all results and write their hashes")
    against = commands.add_parser("compare", help="compute again; exit status 1 on a difference")
    commands.add_parser("list", help="print the names of the results")
    for command in (write, against):
        command.add_argument("file", type=Path, help="lines 'name sha256'")
        command.add_argument(
            "--jobs", type=int, default=1, metavar="N", help="processes (default: 1)"
        )
        command.add_argument(
            "--threads",
            type=int,
            default=0,
            metavar="N",
            help="threads of the core in each process; 0 takes all (default: 0)",
        )
        command.add_argument(
            "--save", type=Path, metavar="FOLDER", help="keep the arrays in FOLDER, a .npz each"
        )
        command.add_argument(
            "--seeds",
            type=int,
            default=8,
            metavar="K",
            help="other seeds whose estimates --save keeps for the z-test (default: 8)",
        )
    for command in commands.choices.values():
        command.add_argument(
            "--only",
            metavar="PATTERN",
            help="results whose names contain PATTERN, or match it as a file name would (fog*)",
        )
    against.add_argument(
        "--against",
        type=Path,
        metavar="FOLDER",
        help="arrays that `write --save` kept: say by how much results differ",
    )
    return made


def main(arguments: list[str] | None = None) -> int:
    """Run a command; returns the exit status."""
    given = parser().parse_args(arguments)
    cases = selected(given.only)
    if not cases:
        print(f"fingerprints.py: --only: no result is named like '{given.only}'", file=sys.stderr)
        return 2
    if given.command == "list":
        print("\n".join(cases))
        return 0
    known = read_lines(given.file) if given.command == "compare" else {}
    found = compute_all(
        cases, jobs=given.jobs, threads=given.threads, save=given.save, title=given.command
    )
    if given.save is not None:
        save_seeds(cases, given.save, seeds=given.seeds, jobs=given.jobs, threads=given.threads)
    if given.command == "write":
        return write(given.file, found)
    wanted = {name: known[name] for name in known if given.only is None or name in cases}
    result = compare(wanted, found)
    print(result)
    if given.against is not None:
        for name in result.different:
            print(describe_difference(cases[name], given.against))
    return 0 if result.equal else 1


def write(path: Path, found: dict[str, str]) -> int:
    """Write a line for each result; returns the exit status, 1 where one has failed."""
    failed = [name for name, digest in found.items() if digest.startswith(FAILED)]
    for name in failed:
        print(f"{name}: {found[name]}", file=sys.stderr)
    if failed:
        print(f"{len(failed)} of {len(found)} results failed, nothing written", file=sys.stderr)
        return 1
    text = "".join(f"{name} {digest}\n" for name, digest in found.items())
    path.write_text(text, encoding="utf-8")
    print(f"{len(found)} results written to {path}")
    return 0


def read_lines(path: Path) -> dict[str, str]:
    """{name: hash} of a file that `write` made."""
    lines = path.read_text(encoding="utf-8").splitlines()
    return dict(line.split() for line in lines if line.strip())


if __name__ == "__main__":
    sys.exit(main())
