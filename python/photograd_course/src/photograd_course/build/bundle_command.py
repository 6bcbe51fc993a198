"""`photograd course bundle`: one zip of one assignment."""

from __future__ import annotations

from pathlib import Path

from ..atomic_io import atomic_write
from ..cli.failures import complain
from ..cli.output import emit, note
from ..student.packing import require_archive_or_free
from .command import bar, chosen_folders, read_wheels
from .course_files import build_of
from .gradescope import gradescope_zip
from .products import sealed
from .rules import findings, seed_findings
from .secret import course_secret, secret_beside


def bundle_command(
    kind: str,
    number: str,
    out: Path | None,
    secret_file: Path | None,
    wheels: Path | None,
    *,
    as_json: bool,
) -> bool:
    """Write the zip; whether every rule is kept.

    Args:
        kind: "gradescope" or "hidden".
        number: of the assignment.
        out, secret_file, wheels: see `photograd course bundle --help`.
        as_json: print the result as JSON.

    Raises:
        IoError, RangeError, SceneError: as for `build_command`.
    """
    root, folders = chosen_folders([number])
    if out is not None:
        require_archive_or_free("bundle", out)
    folder = next(iter(folders.values()))
    target = out or Path(f"{folder.name[:2]}_{kind}.zip")
    # That of `course build`, so that kits and zips of one course fit; else beside the zip.
    products = (root.parent / "build" / "course", target.resolve().parent / "course")
    secret = course_secret(secret_file, [secret_beside(each) for each in products])
    note(secret.explained())
    build = build_of(folder, root=root, secret=secret.value, bar=bar)
    found = findings(build_of(folder, root=root, bar=bar)) or seed_findings(build)
    for each in found:
        complain(str(each))
    if not found:
        data = sealed(build)
        if kind == "gradescope":
            data = gradescope_zip(build.manifest.id, data, secret.value, read_wheels(wheels))
        atomic_write(target, data)
    result = {"ok": not found, "zip": target if not found else None, "secret": secret.place}
    emit({**result, "findings": len(found)}, as_json=as_json)
    return not found
