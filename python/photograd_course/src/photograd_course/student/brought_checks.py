"""Look first at what was brought along, by the checks of the assignments that own it.

Only the functions are looked at that this assignment uses, and those that they use. A later check
that uses a wrong one and fails says so, instead of a hint about what is right.
"""

from __future__ import annotations

import contextlib
import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from ..assignment.bundle import Bundle
from ..assignment.manifest import Manifest
from ..build.kits import Kit, find_kit
from ..errors import IoError
from ..grading.check import Check
from ..grading.outcome import Outcome, Status
from .checking import check_here
from .origins import functions_of, owner_of, text_of
from .record import Record
from .source_code import parsed, unwritten
from .uses import Name, Uses


@dataclass(frozen=True)
class Culprit:
    """One function of an earlier module that is wrong.

    Attributes:
        owner: the assignment that owns it.
        function: its name there.
        outcome: of the first check that says so.
    """

    owner: Manifest
    function: str
    outcome: Outcome

    @property
    def name(self) -> str:
        """Such as "reflectance.gltf"."""
        return f"{self.owner.module}.{self.function}"


@dataclass
class Looked:
    """What is known of the modules that were brought along.

    Attributes:
        culprits: functions that are wrong.
        unreadable: assignments whose module is no Python.
        missing: functions that are used and not written, with the assignment.
        right: assignments whose checks were passed, with the number of those checks.
    """

    culprits: list[Culprit] = field(default_factory=list)
    unreadable: list[Manifest] = field(default_factory=list)
    missing: list[tuple[Manifest, list[str]]] = field(default_factory=list)
    right: list[tuple[Manifest, int]] = field(default_factory=list)

    @property
    def wrong(self) -> dict[str, str]:
        """Names such as "reflectance.gltf", to what a check says that is blocked by it."""
        return {
            each.name: f"{each.outcome.id} (your {each.name} of {each.owner.id})"
            for each in self.culprits
        }


def look_at_brought(
    bundle: Bundle,
    files: Mapping[str, bytes],
    checks: Sequence[Check] | None,
    manifests: Sequence[Manifest],
    record: Record,
) -> Looked:
    """Run the public checks of earlier assignments on the functions that are used here.

    Args:
        bundle: of the assignment.
        files: of the submission.
        checks: those that will be run here; None: all.
        manifests: of all assignments.
        record: of the folder; what has passed before is not run again.
    """
    uses = uses_of(bundle, files)
    if checks is None:
        used = uses.everything()
    else:
        used = frozenset().union(*(uses.reached_by(check) for check in checks))
    looked = Looked()
    owners = [owner_of(name, manifests) for name in bundle.manifest.brought]
    for owner in sorted((each for each in owners if each is not None), key=lambda each: each.id):
        if f"{owner.module}.py" in files and all(f"{name}.py" in files for name in owner.brought):
            _look(owner, files, used, record, looked)
    return looked


def uses_of(bundle: Bundle, files: Mapping[str, bytes]) -> Uses:
    """Who uses whom in a submission.

    Args:
        bundle: of the assignment.
        files: of the submission.
    """
    manifest = bundle.manifest
    modules = (*manifest.brought, manifest.module)
    sources = {name: text_of(files.get(f"{name}.py", b"")) for name in modules}
    if bundle.adapters is not None:
        sources["adapters"] = bundle.adapters
    return Uses(sources, manifest.module)


def with_needs(checks: Sequence[Check], uses: Uses, looked: Looked) -> list[Check]:
    """The checks, of which each needs those wrong functions that it uses."""
    wrong = looked.wrong
    return [
        replace(check, needs=(*check.needs, *_names(uses.reached_by(check), wrong)))
        for check in checks
    ]


def _names(reached: frozenset[Name], wrong: Mapping[str, str]) -> list[str]:
    found = {".".join(name) for name in reached}
    return [name for name in wrong if _top(name) in found]


def _top(name: str) -> str:
    """Without the method: "engine.Value" of "engine.Value.exp"."""
    return ".".join(name.split(".")[:2])


def _look(
    owner: Manifest,
    files: Mapping[str, bytes],
    used: frozenset[Name],
    record: Record,
    looked: Looked,
) -> None:
    kit = find_kit(owner.id)
    own = {name for module, name in used if module == owner.module}
    source = text_of(files[f"{owner.module}.py"])
    if parsed(source) is None:
        looked.unreadable.append(owner)
        return
    stubs = unwritten(source, functions_of(owner))
    if missing := [name for name in stubs if name.partition(".")[0] in own]:
        looked.missing.append((owner, missing))
    checks = [
        check
        for check in kit.bundle.checks
        if own & {name.partition(".")[0] for name in check.calls} and not {*stubs} & {*check.calls}
    ]
    if not checks:
        return
    digest = _digest(kit, files)
    passed = record.passed(digest)
    open_checks = [check for check in checks if check.id not in passed]
    outcomes: list[Outcome] = []
    if open_checks:
        needing = with_needs(open_checks, uses_of(kit.bundle, files), looked)
        outcomes = check_here(kit.bundle, files, needing, wrong=looked.wrong)
    if now := [outcome.id for outcome in outcomes if outcome.status is Status.PASSED]:
        with contextlib.suppress(IoError):  # it only saves time
            record.note_passed(digest, f"{owner.id} ", now)
    looked.culprits += _culprits(owner, open_checks, outcomes)
    if len(now) == len(open_checks):
        looked.right.append((owner, len(checks)))


def _culprits(
    owner: Manifest, checks: Sequence[Check], outcomes: Sequence[Outcome]
) -> list[Culprit]:
    """The functions that failed by themselves, each with the first check that says so."""
    found: dict[str, Culprit] = {}
    asked = set(functions_of(owner))
    for check, outcome in zip(checks, outcomes, strict=True):
        if outcome.status is not Status.FAILED or outcome.reason == "not implemented":
            continue
        for function in [name for name in check.calls if name in asked] or check.calls:
            found.setdefault(function, Culprit(owner, function, outcome))
    return list(found.values())


def _digest(kit: Kit, files: Mapping[str, bytes]) -> str:
    """Of the modules, and of what looks at them; it begins with the assignment's number."""
    modules = (*kit.manifest.brought, kit.manifest.module)
    parts = [hashlib.sha256(files[f"{name}.py"]).hexdigest() for name in modules]
    digest = hashlib.sha256(" ".join([*parts, kit.digest]).encode()).hexdigest()
    return f"{kit.manifest.id} {digest}"
