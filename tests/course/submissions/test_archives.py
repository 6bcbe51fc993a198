"""Archives other than a zip: read within limits where the standard library can, else refused."""

from __future__ import annotations

import bz2
import gzip
import io
import lzma
import tarfile
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from photograd_course.assignment.bundle import Bundle
from photograd_course.submissions import containers, tar
from photograd_course.submissions.containers import UNREAD
from photograd_course.submissions.intake import take
from photograd_course.submissions.submission import Submission
from photograd_course.submissions.tar import TarError, members

GOOD = b"x = 1\n"
PACK: dict[str, Callable[[bytes], bytes]] = {
    ".tar": bytes,
    ".tar.gz": gzip.compress,
    ".tgz": gzip.compress,
    ".tar.bz2": bz2.compress,
    ".tar.xz": lzma.compress,
}
FORMATS = {"ustar": tarfile.USTAR_FORMAT, "gnu": tarfile.GNU_FORMAT, "pax": tarfile.PAX_FORMAT}


def tar_of(files: dict[str, bytes], form: int = tarfile.PAX_FORMAT) -> bytes:
    data = io.BytesIO()
    with tarfile.open(fileobj=data, mode="w", format=form) as archive:
        for name, content in files.items():
            info = tarfile.TarInfo(name)
            info.size = len(content)
            archive.addfile(info, io.BytesIO(content))
    return data.getvalue()


def zip_of(files: dict[str, bytes]) -> bytes:
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return data.getvalue()


def taken(bundle: Bundle, folder: Path, name: str, data: bytes) -> Submission:
    path = folder / name
    path.write_bytes(data)
    before = sorted(folder.rglob("*"))
    result = take(bundle.manifest, path)
    assert sorted(folder.rglob("*")) == before, "something was unpacked"
    return result


@pytest.mark.parametrize("ending", PACK)
def test_tar_archives_are_read(bundle: Bundle, tmp_path: Path, ending: str) -> None:
    files = {"./90_toy/toy.py": GOOD, "./90_toy/answers.toml": b"student = 'A'\n"}
    found = taken(bundle, tmp_path, f"work{ending}", PACK[ending](tar_of(files)))
    assert found.files == {"toy.py": GOOD, "answers.toml": b"student = 'A'\n"}
    assert not found.problem


@pytest.mark.parametrize("form", FORMATS)
def test_names_and_contents_are_those_that_tarfile_reads(form: str) -> None:
    long = "a" * 40 + "/" + "b" * 60 + "/toy.py"
    files = {long: GOOD, "toy.py": b"#" * 1000, "empty": b"", "gr\u00fcn.py": b"1"}
    data = tar_of(files, FORMATS[form])
    found = {each.name: bytes(each.data) for each in members(data, 100)}
    with tarfile.open(fileobj=io.BytesIO(data)) as archive:
        oracle = {info.name: archive.extractfile(info).read() for info in archive}  # type: ignore[union-attr]
    assert found == oracle == files


@pytest.mark.parametrize(
    ("kind", "word"), [(tarfile.SYMTYPE, "link"), (tarfile.LNKTYPE, "link"), (b"3", "device")]
)
def test_links_and_devices_in_a_tar(bundle: Bundle, tmp_path: Path, kind: bytes, word: str) -> None:
    data = io.BytesIO()
    with tarfile.open(fileobj=data, mode="w") as archive:
        info = tarfile.TarInfo("toy.py")
        info.type, info.linkname = kind, "/etc/passwd"
        archive.addfile(info)
    found = taken(bundle, tmp_path, "work.tar", data.getvalue())
    assert found.files == {}
    assert f"toy.py is a {word}, not a plain file" in found.problem


@pytest.mark.parametrize("name", ["../toy.py", "/toy.py", "a/../toy.py"])
def test_names_that_lead_elsewhere_are_never_taken(
    bundle: Bundle, tmp_path: Path, name: str
) -> None:
    found = taken(bundle, tmp_path, "work.tar", tar_of({name: GOOD}))
    assert found.files == {}
    assert "there is no toy.py" in found.problem


@pytest.mark.parametrize("ending", PACK)
def test_what_unpacks_to_too_much_is_refused(
    bundle: Bundle, tmp_path: Path, ending: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tar, "MOST_UNPACKED", 1 << 20)
    bomb = PACK[ending](tar_of({"toy.py": GOOD, "big": bytes(1 << 20)}))
    assert "unpacks to more than 1 MB" in taken(bundle, tmp_path, f"b{ending}", bomb).problem


def test_damaged_tar_archives_end_in_a_sentence(bundle: Bundle, tmp_path: Path) -> None:
    whole = tar_of({"toy.py": GOOD * 50, "answers.toml": b"student = 'A'\n"}, tarfile.GNU_FORMAT)
    refusals = 0
    for at in range(0, 1600, 3):
        damaged = bytearray(whole)
        damaged[at] ^= 0x55
        found = taken(bundle, tmp_path, "work.tar", bytes(damaged))
        assert found.problem or "toy.py" in found.files
        refusals += bool(found.problem)
    assert refusals > 100
    for data in (b"", b"x" * 600, whole[:700], gzip.compress(whole)[:40], bytes(1024)):
        assert taken(bundle, tmp_path, "work.tar", data).problem


def test_sizes_below_zero_and_beyond_the_archive() -> None:
    header = bytearray(tar_of({"toy.py": GOOD}, tarfile.USTAR_FORMAT))
    for field in (b"-0000000512\0", b"77777777777\0", b"\xff" * 12, b"\x80" + b"\0" * 10 + b"\1"):
        header[124:136] = field
        header[148:156] = b" " * 8
        header[148:156] = b"%06o\0 " % sum(header[:512])
        with pytest.raises(TarError):
            members(bytes(header), 10)


def test_an_archive_in_an_archive(bundle: Bundle, tmp_path: Path) -> None:
    inner = zip_of({"toy.py": GOOD})
    assert taken(bundle, tmp_path, "a.zip", zip_of({"w/inner.zip": inner})).files == {
        "toy.py": GOOD
    }
    assert taken(bundle, tmp_path, "b.tgz", gzip.compress(tar_of({"in.zip": inner}))).files
    third = zip_of({"b.zip": zip_of({"a.zip": inner})})
    assert "is an archive that is not read" in taken(bundle, tmp_path, "c.zip", third).problem
    two = zip_of({"a.zip": inner, "b.zip": inner})
    assert "several archives (a.zip, b.zip)" in taken(bundle, tmp_path, "d.zip", two).problem


def test_files_beside_an_archive(bundle: Bundle, tmp_path: Path) -> None:
    answers = b"student = 'A'\n"
    (tmp_path / "ada").mkdir()
    (tmp_path / "ada" / "work.zip").write_bytes(zip_of({"90_toy/toy.py": GOOD}))
    (tmp_path / "ada" / "answers.toml").write_bytes(answers)
    (tmp_path / "ada" / "notes.txt").write_bytes(b"hello")
    found = take(bundle.manifest, tmp_path / "ada")
    assert found.files == {"toy.py": GOOD, "answers.toml": answers}
    assert found.ignored == ("notes.txt: not a file of this assignment",)
    both = zip_of({"90_toy/toy.py": GOOD, "90_toy/answers.toml": b"student = 'B'\n"})
    (tmp_path / "ada" / "work.zip").write_bytes(both)
    found = take(bundle.manifest, tmp_path / "ada")
    assert found.files["answers.toml"] == b"student = 'B'\n"
    assert any("answers.toml: lies beside an archive" in each for each in found.ignored)


@pytest.mark.parametrize("ending", UNREAD)
def test_archives_that_are_not_read_say_what_to_do(
    bundle: Bundle, tmp_path: Path, ending: str
) -> None:
    problem = taken(bundle, tmp_path, f"work{ending}", b"7z\xbc\xaf").problem
    assert f"work{ending} is an archive that is not read, hand in a zip of toy.py" in problem


def test_an_encrypted_zip_says_so(bundle: Bundle, tmp_path: Path) -> None:
    data = bytearray(zip_of({"toy.py": GOOD}))
    for mark, at in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        data[data.index(mark) + at] |= 1
    problem = taken(bundle, tmp_path, "work.zip", bytes(data)).problem
    assert "toy.py is encrypted: hand in a zip without a password" in problem


def test_an_archive_that_is_too_large(
    bundle: Bundle, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(containers, "LARGEST_ARCHIVE", 1 << 20)
    data = zip_of({"toy.py": GOOD}) + bytes(1 << 20)
    for name in ("work.zip", "work.tar"):
        assert "is larger than 1 MB" in taken(bundle, tmp_path, name, data).problem


def test_the_module_deep_in_one_of_several_folders(bundle: Bundle, tmp_path: Path) -> None:
    files = {"src/90_toy/toy.py": GOOD, "docs/notes.md": b"x", "answers.toml": b"student = 'A'\n"}
    found = taken(bundle, tmp_path, "work.zip", zip_of(files))
    assert found.files == {"toy.py": GOOD}
    assert "answers.toml: lies elsewhere: move it, files are taken in src/90_toy/ only" in (
        found.ignored
    )
