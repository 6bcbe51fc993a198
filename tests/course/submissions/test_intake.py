"""Archives and folders made to harm: nothing is unpacked, and each failure is a sentence."""

from __future__ import annotations

import io
import os
import stat
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from photograd_course.assignment.bundle import Bundle
from photograd_course.submissions.intake import take
from photograd_course.submissions.submission import OTHER_BYTES, SOURCE_BYTES, Submission

GOOD = b"x = 1\n"
Take = Callable[[bytes], Submission]


def zipped(*entries: tuple[str | zipfile.ZipInfo, bytes]) -> bytes:
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in entries:
            archive.writestr(name, content)
    return data.getvalue()


def special(name: str, mode: int) -> zipfile.ZipInfo:
    info = zipfile.ZipInfo(name)
    info.create_system, info.external_attr = 3, (mode | 0o644) << 16
    return info


@pytest.fixture
def take_zip(bundle: Bundle, tmp_path: Path) -> Take:
    def taken(data: bytes) -> Submission:
        path = tmp_path / "hand.zip"
        path.write_bytes(data)
        before = sorted(tmp_path.rglob("*"))
        result = take(bundle.manifest, path)
        assert sorted(tmp_path.rglob("*")) == before, "something was unpacked"
        return result

    return taken


def test_a_plain_zip_and_one_with_a_folder_around(take_zip: Take) -> None:
    flat = take_zip(zipped(("toy.py", GOOD), ("answers.toml", b"student = 'A'\n")))
    nested = take_zip(zipped(("90_toy/toy.py", GOOD), ("90_toy/answers.toml", b"student = 'A'\n")))
    assert flat.files == nested.files == {"toy.py": GOOD, "answers.toml": b"student = 'A'\n"}
    assert not flat.problem
    assert flat.digest == nested.digest
    assert flat.digest != take_zip(zipped(("toy.py", GOOD + b"#"))).digest


def test_what_does_not_belong_is_left_out_and_named(take_zip: Take) -> None:
    taken = take_zip(
        zipped(
            ("toy.py", GOOD),
            ("numpy.py", b"1"),
            ("conftest.py", b"1"),
            (".git/config", b"1"),
            ("notes.txt", b"1"),
            ("__MACOSX/._toy.py", b"1"),
            ("sub/toy.pth", b"1"),
        )
    )
    assert set(taken.files) == {"toy.py"}
    named = " ".join(taken.ignored)
    for name in ("numpy.py", "conftest.py", ".git/config", "notes.txt", "sub/toy.pth"):
        assert name in named


@pytest.mark.parametrize(
    "name", ["../toy.py", "/toy.py", "a/../toy.py", "C:/toy.py", "..\\toy.py", "to\x1b[2Jy.py"]
)
def test_names_that_lead_elsewhere_are_never_taken(take_zip: Take, name: str) -> None:
    taken = take_zip(zipped((name, GOOD)))
    assert taken.files == {}
    assert "there is no toy.py" in taken.problem
    assert len(taken.ignored) == 1
    assert "\x1b" not in taken.ignored[0]


@pytest.mark.parametrize(
    ("mode", "word"), [(stat.S_IFLNK, "link"), (stat.S_IFCHR, "device"), (stat.S_IFIFO, "device")]
)
def test_links_and_devices_in_a_zip(take_zip: Take, mode: int, word: str) -> None:
    taken = take_zip(zipped((special("toy.py", mode), b"/etc/passwd")))
    assert taken.files == {}
    assert f"toy.py is a {word}, not a plain file" in taken.problem


def test_a_zip_bomb_is_refused_by_its_declared_size(take_zip: Take) -> None:
    taken = take_zip(zipped(("toy.py", b"\n" * (64 << 20))))
    assert taken.files == {}
    assert "longer than the 200 KB" in taken.problem


def test_a_zip_bomb_that_lies_about_its_size(take_zip: Take) -> None:
    data = bytearray(zipped(("toy.py", b"\n" * (8 << 20))))
    for magic, offset in ((b"PK\x03\x04", 22), (b"PK\x01\x02", 24)):  # where the sizes stand
        at = data.index(magic) + offset
        data[at : at + 4] = struct.pack("<I", 1000)
    taken = take_zip(bytes(data))
    assert taken.files == {}
    assert taken.problem


def test_a_big_bomb_beside_the_submission_is_not_even_read(take_zip: Take) -> None:
    taken = take_zip(zipped(("toy.py", GOOD), ("big.bin", bytes(64 << 20))))
    assert taken.files == {"toy.py": GOOD}


@pytest.mark.parametrize(
    "names", [("toy.py", "Toy.py"), ("toy.py", "TOY.PY"), ("toy.py", "ｔoy.py")]
)
def test_names_that_some_file_systems_confuse(take_zip: Take, names: tuple[str, str]) -> None:
    taken = take_zip(zipped(*((name, GOOD) for name in names)))
    assert taken.files == {}
    assert "keep one" in taken.problem


def test_wrong_case_alone_says_what_to_do(take_zip: Take) -> None:
    assert (
        "expected a file toy.py, found Toy.py: rename it"
        in take_zip(zipped(("Toy.py", GOOD))).problem
    )


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_the_same_name_twice(take_zip: Take) -> None:
    assert "twice" in take_zip(zipped(("toy.py", GOOD), ("toy.py", b"y = 2\n"))).problem


def test_two_folders_with_the_module(take_zip: Take) -> None:
    taken = take_zip(zipped(("a/toy.py", GOOD), ("b/toy.py", GOOD)))
    assert "several folders (a, b)" in taken.problem


def test_too_many_entries(take_zip: Take) -> None:
    taken = take_zip(zipped(("toy.py", GOOD), *((f"f{k}", b"") for k in range(5001))))
    assert "more than 5000 files" in taken.problem


def test_a_repository_around_the_submission_does_not_count(
    take_zip: Take, bundle: Bundle, tmp_path: Path
) -> None:
    objects = [(f".git/objects/f{k}", b"") for k in range(5001)]
    assert take_zip(zipped(("toy.py", GOOD), *objects)).files == {"toy.py": GOOD}
    folder = tmp_path / "work"
    (folder / ".git" / "objects").mkdir(parents=True)
    (folder / ".git" / "objects" / "toy.py").write_bytes(b"y = 2\n")
    (folder / "toy.py").write_bytes(GOOD)
    taken = take(bundle.manifest, folder)
    assert taken.files == {"toy.py": GOOD}
    assert any(".git" in entry for entry in taken.ignored)


@pytest.mark.parametrize("data", [b"", b"PK", b"not a zip at all", b"\x00" * 1000])
def test_garbage(take_zip: Take, data: bytes) -> None:
    taken = take_zip(data)
    assert taken.files == {}
    assert "no readable zip archive" in taken.problem


def test_damaged_zips_never_raise(take_zip: Take) -> None:
    whole = zipped(("toy.py", b"x = 1\n" * 50), ("answers.toml", b"student = 'A'\n" * 20))
    refusals = 0
    for at in range(0, len(whole), 3):
        damaged = bytearray(whole)
        damaged[at] ^= 0x55
        taken = take_zip(bytes(damaged))
        assert taken.problem or "toy.py" in taken.files
        refusals += bool(taken.problem)
    assert refusals > 20  # most places matter


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"x = 1\n\0", "line 2: holds a NUL byte"),
        (b"x = 1\n# caf\xe9\n", "line 2: is not UTF-8"),
        (b"#" * (SOURCE_BYTES + 1), "longer than the 200 KB"),
    ],
)
def test_contents_that_cannot_be_judged(take_zip: Take, content: bytes, says: str) -> None:
    taken = take_zip(zipped(("toy.py", content)))
    assert "toy.py" not in taken.files
    assert says in taken.problem


def test_bad_answers_do_not_spoil_the_code(take_zip: Take) -> None:
    taken = take_zip(zipped(("toy.py", GOOD), ("answers.toml", b"\xff\xfe")))
    assert not taken.problem
    assert set(taken.files) == {"toy.py"}
    assert any("answers.toml" in warning and "UTF-8" in warning for warning in taken.warnings)
    too_long = take_zip(zipped(("toy.py", GOOD), ("answers.toml", b"#" * (OTHER_BYTES + 1))))
    assert "64 KB" in too_long.problem


def test_the_mark_that_notepad_adds_is_removed(take_zip: Take) -> None:
    assert take_zip(zipped(("toy.py", b"\xef\xbb\xbf" + GOOD))).files["toy.py"] == GOOD


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no such files on this system")
def test_links_and_pipes_in_a_folder(bundle: Bundle, tmp_path: Path) -> None:
    secret = tmp_path / "secret.py"
    secret.write_bytes(GOOD)
    for make, word in ((lambda p: p.symlink_to(secret), "link"), (os.mkfifo, "device")):
        folder = tmp_path / word
        folder.mkdir()
        make(folder / "toy.py")
        taken = take(bundle.manifest, folder)
        assert taken.files == {}
        assert word in taken.problem
    link = tmp_path / "linked"
    link.symlink_to(tmp_path / "link", target_is_directory=True)
    assert "no plain file" in take(bundle.manifest, link).problem
