"""Learning systems' exports, as their documentation shows them, of what a class has handed in."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path

from .class_of_30 import HandIn


def flat(class_: Sequence[HandIn], target: Path) -> None:
    """A folder with a zip for each student."""
    for each in class_:
        if each.files:
            (target / f"{each.student} {each.number}.zip").write_bytes(zipped(each.files))


def folders(class_: Sequence[HandIn], target: Path) -> None:
    """A folder for each student."""
    for each in class_:
        lay(target / f"{each.student} {each.number}", each.files)


def gradescope(class_: Sequence[HandIn], target: Path) -> None:
    """Folders "submission_N", and who handed them in."""
    lines = ["---"]
    for each in class_:
        lay(target / f"submission_{each.number}", each.files)
        lines += [
            f"submission_{each.number}:",
            "  :submitters:",
            f"  - :name: {_yaml(each.student)}",
            f"    :sid: '{each.number}'",
            f"    :email: s{each.number}@example.edu",
            "  :created_at: 2026-11-20 10:00:00.000000000 Z",
            "  :status: processed",
        ]
    (target / "submission_metadata.yml").write_text("\n".join(lines) + "\n", encoding="utf-8")


def canvas(class_: Sequence[HandIn], target: Path) -> None:
    """All files in one folder: lastfirst_LATE_user_attachment_name."""
    for each in class_:
        first, _, last = each.student.partition(" ")
        who = "".join(filter(str.isalnum, f"{last}{first}".lower()))
        late = "LATE_" if each.late else ""
        for k, (name, data) in enumerate(sorted(each.files.items())):
            stem, dot, suffix = name.rpartition(".")
            again = f"{stem}-1{dot}{suffix}" if each.earlier else name  # only the last is exported
            path = target / f"{who}_{late}{each.number}_{900000 + 100 * each.number + k}_{again}"
            path.write_bytes(data)
        if not each.files:
            path = target / f"{who}_{each.number}_text.html"
            path.write_text("<p>I could not upload it.</p>", encoding="utf-8")


def moodle(class_: Sequence[HandIn], target: Path) -> None:
    """A folder for each participant."""
    for each in class_:
        stem = f"{each.student}_{each.number}_assignsubmission"
        lay(target / f"{stem}_file", each.files)
        if not each.files:
            lay(target / f"{stem}_onlinetext", {"onlinetext.html": b"<p>See my e-mail.</p>"})


def blackboard(class_: Sequence[HandIn], target: Path) -> None:
    """Files with the attempt's time in the name, and a receipt for each attempt."""
    for each in class_:
        attempts = [(each.earlier, "2026-11-18-09-00-00")] if each.earlier else []
        for files, when in [*attempts, (each.files, "2026-11-20-10-00-00")]:
            stem = f"Assignment_s{each.number}_attempt_{when}"
            for name, data in files.items():
                (target / f"{stem}_{name}").write_bytes(data)
            receipt = f"Name: {each.student} (s{each.number})\nAssignment: Assignment\n"
            (target / f"{stem}.txt").write_text(receipt, encoding="utf-8")


def brightspace(class_: Sequence[HandIn], target: Path) -> None:
    """A folder for each attempt: ids, name, time; and an index."""
    for each in class_:
        attempts = [(each.earlier, "Nov 18, 2026 900 AM")] if each.earlier else []
        for files, when in [*attempts, (each.files, "Nov 20, 2026 1000 AM")]:
            lay(target / f"{each.number}-7001 - {each.student} - {when}", files)
    (target / "index.html").write_text("<html><body>Submissions</body></html>", encoding="utf-8")


LAYOUTS: tuple[Callable[[Sequence[HandIn], Path], None], ...] = (
    flat,
    gradescope,
    canvas,
    moodle,
    blackboard,
    brightspace,
    folders,
)


def zipped(files: dict[str, bytes]) -> bytes:
    """A zip as an operating system makes it, in a folder of its own."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for name, content in files.items():
            archive.writestr(f"work/{name}", content)
            archive.writestr(f"__MACOSX/work/._{name}", b"\x00\x05\x16\x07")
    return data.getvalue()


def lay(folder: Path, files: dict[str, bytes]) -> None:
    """The files in a folder, which is made."""
    folder.mkdir(parents=True)
    for name, content in files.items():
        (folder / name).write_bytes(content)


def _yaml(text: str) -> str:
    return "'" + text.replace("'", "''") + "'"
