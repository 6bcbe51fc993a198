"""A mode is taken because it was tried, and a worker is believed because it has proved itself."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from photograd_course.errors import RangeError
from photograd_course.grading import GraderFault, Status
from photograd_course.worker import launch, modes, self_test, syscall_filter
from photograd_course.worker.home import WorkerHome

from course.isolation.support import LIMITS, SOLUTION, outcomes_of


def test_the_promises_hold_here(mode: str, tmp_path: Path) -> None:
    tmp_path.chmod(0o700)
    secret = tmp_path / "expected.npz"
    secret.write_text("the answers")
    secret.chmod(0o600)
    assert self_test.self_test(mode, (tmp_path, secret)) == ""


def test_a_secret_that_can_be_read_is_found_out(
    strict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Something that every confined worker may read, named as a secret.
    readable = Path(launch.places.numpy_folders()[0]) / "__init__.py"
    monkeypatch.setattr(launch, "may_change_root", lambda: False)
    if strict in "BC" and not anybody_can_read(readable):
        folder = folder_for_all(monkeypatch)
        readable = folder / "open"
        readable.write_text("open")
        readable.chmod(0o644)
        monkeypatch.setattr(launch.places, "readable", lambda: (str(readable),))
    reason = self_test.self_test(strict, (readable,))
    self_test.self_test.cache_clear()
    assert reason == f"a worker could get what is in {readable}"


def anybody_can_read(path: Path) -> bool:
    return all(place.stat().st_mode & 0o005 == 0o005 for place in path.parents)


def folder_for_all(monkeypatch: pytest.MonkeyPatch) -> Path:
    home = WorkerHome()
    monkeypatch.setattr(self_test, "WorkerHome", lambda: home)
    return home.folder


@pytest.mark.parametrize(
    ("works", "minimum", "only", "chosen"),
    [
        ("ABCDE", None, None, "A"),
        ("CDE", None, None, "C"),
        ("CDE", "C", None, "C"),
        ("E", None, None, "E"),
        ("ABCDE", "C", "B", "B"),
        ("ABCDE", None, "E", "E"),
    ],
)
def test_the_strongest_that_works(
    works: str, minimum: str | None, only: str | None, chosen: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(modes, "self_test", lambda mode, _: "" if mode in works else "broken")
    assert modes.choose(minimum, only) == chosen


@pytest.mark.parametrize(
    ("works", "minimum", "only", "says"),
    [
        ("DE", "C", None, "C (another user): broken here"),
        ("CDE", "C", "A", "A (bubblewrap): broken here"),
        ("CDE", "C", "E", "weaker than the required C"),
    ],
)
def test_too_weak_is_our_fault(
    works: str, minimum: str, only: str | None, says: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(modes, "self_test", lambda mode, _: "" if mode in works else "broken here")
    with pytest.raises(GraderFault) as caught:
        modes.choose(minimum, only)
    assert says in str(caught.value)


def test_an_unknown_mode_is_refused() -> None:
    with pytest.raises(RangeError):
        modes.choose("F")


def test_a_missing_layer_is_noticed(
    strict: str, home: WorkerHome, monkeypatch: pytest.MonkeyPatch
) -> None:
    honest = launch.policy_of

    def promise_more(*args: object) -> object:
        policy = honest(*args)  # type: ignore[arg-type]
        return replace(policy, layers=policy.layers | {"a wall"})

    monkeypatch.setattr(launch, "policy_of", promise_more)
    with pytest.raises(GraderFault, match="not in force: a wall"):
        launch.open_worker(home, strict, LIMITS)


def test_a_worker_that_does_not_start_costs_no_points(
    home: WorkerHome, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(launch, "plain_command", lambda _: ["/nowhere/python"])
    found = outcomes_of(SOLUTION, home, "E")
    assert {each.status for each in found} == {Status.ERROR_OURS}
    assert all("cannot be started" in each.text for each in found)


def test_a_layer_that_does_not_hold_is_not_reported(
    strict: str, home: WorkerHome, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A filter that filters nothing."""
    import pyseccomp

    def harmless() -> bytes:
        table = pyseccomp.SyscallFilter(pyseccomp.ALLOW)
        path = home.folder / "filter"
        with path.open("w+b") as file:
            table.export_bpf(file)
        return path.read_bytes()

    monkeypatch.setattr(syscall_filter, "compiled_filter", harmless)
    with pytest.raises(GraderFault, match="not in force: system calls"):
        launch.open_worker(home, strict, LIMITS)


def test_without_libseccomp_only_bubblewrap_serves(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing() -> bytes:
        raise ImportError("No module named 'pyseccomp'")

    before = {mode: self_test.self_test(mode) for mode in "ABCD"}
    monkeypatch.setattr(syscall_filter, "compiled_filter", missing)
    self_test.self_test.cache_clear()
    after = {mode: self_test.self_test(mode) for mode in "ABCD"}
    self_test.self_test.cache_clear()
    assert after["A"] == before["A"]
    for mode in "BCD":
        assert "photograd-course[grader]" in after[mode] or before[mode] != ""
