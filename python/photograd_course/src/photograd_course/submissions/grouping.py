"""Put the entries of an export together: one submission for each student, the newest attempt."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ..assignment.manifest import Manifest
from .blackboard_receipt import Receipt, read_receipt
from .intake import as_wanted
from .layouts import RECEIPT, TEXT, WORK, Label
from .listing import Entry, key_of, last_of
from .source import Part, Person, Source

_COPY_NUMBER = re.compile(r"-(\d{1,3})(?=\.[A-Za-z.]+$)")


@dataclass(frozen=True)
class Claim:
    """An entry that is a submission or a part of one; without a label it is one by itself."""

    entry: Entry
    label: Label | None


def grouped(manifest: Manifest, path: Path, claims: Sequence[Claim]) -> list[Source]:
    """The submissions; every claim is among the entries of exactly one.

    Args:
        manifest: of the assignment.
        path: of the folder or archive.
        claims: of one level.
    """
    sources: list[Source] = []
    groups: dict[tuple[str, str], list[tuple[Entry, Label]]] = {}
    for claim in claims:
        if claim.label is None:
            sources.append(_single(manifest, path, claim.entry))
        else:
            key = (claim.label.system, key_of(claim.label.key))
            groups.setdefault(key, []).append((claim.entry, claim.label))
    return sources + [_together(manifest, path, group) for group in groups.values()]


def _single(manifest: Manifest, path: Path, entry: Entry) -> Source:
    name = unicodedata.normalize("NFC", last_of(entry.name))
    student = name if entry.kind == "folder" else stem_of(name)
    part = Part("" if entry.kind == "folder" else as_wanted(manifest, name), entry)
    return Source(student, path / entry.name, (part,), (Person(student),), entries=(entry.name,))


def stem_of(name: str) -> str:
    """The name of a file without its ending, of which `.tar.gz` is one."""
    lower = name.lower()
    for ending in (".tar.gz", ".tar.bz2", ".tar.xz", ".tar.zst", ".tar.z", ".py.txt"):
        if lower.endswith(ending) and len(name) > len(ending):
            return name[: -len(ending)]
    stem, dot, _ = name.rpartition(".")
    return stem if dot and stem else name


def _together(manifest: Manifest, path: Path, group: Sequence[tuple[Entry, Label]]) -> Source:
    """One submission of the entries of one student."""
    first = group[0][1]
    receipts = {each: read_receipt(each[0]) for each in group if each[1].role == RECEIPT}
    name = next((r.name for r in receipts.values() if r.name), first.name)
    source = Source(
        f"{name} ({first.id})" if first.id else name,
        path / group[0][0].name,
        people=(Person(name, first.id),),
        is_late=any(label.is_late for _, label in group),
        entries=tuple(entry.name for entry, _ in group),
    )
    work, fault, notes = _newest_attempt(group)
    if fault:
        return replace(source, problem=fault)
    files = [each for each in work if each[1].role == WORK]
    if not files:
        return replace(source, problem=_without_files(manifest, work, receipts), notes=notes)
    originals = {k: v for receipt in receipts.values() for k, v in receipt.originals.items()}
    kept, fault, more = _newest_files(manifest, files, originals)
    notes = (*notes, *more, *_typed(work, receipts))
    if fault:
        return replace(source, problem=fault, notes=notes)
    return replace(source, parts=tuple(Part(name, entry) for name, entry in kept), notes=notes)


def _newest_attempt(
    group: Sequence[tuple[Entry, Label]],
) -> tuple[list[tuple[Entry, Label]], str, tuple[str, ...]]:
    """The entries of the attempt that counts; why there is none; which others there are."""
    attempts: dict[str, str] = {label.attempt: label.when for _, label in group}
    if len(attempts) == 1:
        return list(group), "", ()
    names = ", ".join(sorted(attempts))
    if "" in attempts.values() or len(set(attempts.values())) < len(attempts):
        return [], f"there are several attempts ({names}) and no order: keep one", ()
    newest = max(attempts, key=lambda each: attempts[each])
    others = ", ".join(sorted((a for a in attempts if a != newest), key=lambda a: attempts[a]))
    note = f"the newest attempt counts, {newest}; not graded: {others}"
    return [each for each in group if each[1].attempt == newest], "", (note,)


def _newest_files(
    manifest: Manifest, files: Sequence[tuple[Entry, Label]], originals: dict[str, str]
) -> tuple[list[tuple[str, Entry]], str, tuple[str, ...]]:
    """Files by their students' names; of one that was handed in again, the newest.

    Returns:
        Names and entries; why they cannot be told apart; which ones do not count.
    """
    versions: dict[str, list[tuple[Entry, Label]]] = {}
    for entry, label in files:
        versions.setdefault(_own_name(manifest, entry, label, originals), []).append((entry, label))
    kept: list[tuple[str, Entry]] = []
    notes: list[str] = []
    for name, several in versions.items():
        by_name = sorted(several, key=lambda each: _copy_number(each[1].file))
        by_number = sorted(several, key=lambda each: each[1].when)
        distinct = len({each[1].when for each in several}) == len(several)
        if len(several) > 1 and (not distinct or by_name != by_number):
            names = ", ".join(entry.name for entry, _ in several)
            return [], f"{name} is there several times ({names}) and no order: keep one", ()
        kept.append((name, by_number[-1][0]))
        if len(several) > 1:
            others = ", ".join(entry.name for entry, _ in by_number[:-1])
            notes.append(f"the newest {name} counts, {by_number[-1][0].name}; not graded: {others}")
    return kept, "", tuple(notes)


def _own_name(manifest: Manifest, entry: Entry, label: Label, originals: dict[str, str]) -> str:
    if entry.kind == "folder":
        return label.file
    if last_of(entry.name) in originals:
        return originals[last_of(entry.name)].replace("/", "_")
    if label.system != "Canvas":
        return as_wanted(manifest, label.file or last_of(entry.name))
    return _COPY_NUMBER.sub("", label.file)


def _copy_number(name: str) -> int:
    found = _COPY_NUMBER.search(name)
    return int(found[1]) if found else 0


def _typed(
    work: Sequence[tuple[Entry, Label]], receipts: dict[tuple[Entry, Label], Receipt]
) -> list[str]:
    has_text = any(label.role == TEXT for _, label in work)
    has_text |= any(receipts[each].is_typed for each in work if each in receipts)
    return ["text that was typed online is not graded"] if has_text else []


def _without_files(
    manifest: Manifest,
    work: Sequence[tuple[Entry, Label]],
    receipts: dict[tuple[Entry, Label], Receipt],
) -> str:
    module = f"{manifest.module}.py"
    if _typed(work, receipts):
        return f"text was typed online, which is not graded: hand in the file {module}"
    return f"there is no file in the submission: hand in {module}"
