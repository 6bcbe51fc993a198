"""Which isolation this machine has, found out by trying, and which one to take."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..errors import RangeError, message
from ..grading.failures import GraderFault
from .policy import MODES, TITLES
from .self_test import COURSE, self_test


def probe(secrets: Sequence[Path] = ()) -> dict[str, str]:
    """For each mode "" where it works here, else the reason why not; tried once per process."""
    return {mode: self_test(mode, tuple(secrets)) for mode in MODES}


def choose(
    minimum: str | None = None, only: str | None = None, secrets: Sequence[Path] = ()
) -> str:
    """The strongest mode that works on this machine.

    Args:
        minimum: weakest acceptable mode, such as the manifest's `minimum_mode`; None takes any.
        only: this mode or none.
        secrets: files and folders that no worker may read; given to the self-test.

    Raises:
        GraderFault: none that is strong enough works; the text tells staff why. Submissions then
            have no verdict, instead of zero points.
        RangeError: there is no such mode.
    """
    for name, value in (("minimum", minimum), ("only", only)):
        if value is not None and value not in MODES:
            raise RangeError(message("choose", name, f"one of {', '.join(MODES)}", repr(value)))
    candidates = (only,) if only is not None else MODES[: MODES.index(minimum or "E") + 1]
    if only is not None and minimum is not None and only > minimum:
        raise GraderFault(f"isolation {TITLES[only]} is weaker than the required {minimum}")
    reasons = []
    for mode in candidates:
        reason = self_test(mode, tuple(secrets))
        if not reason:
            return mode
        reasons.append(f"  {TITLES[mode]}: {reason}")
    text = "\n".join(reasons)
    raise GraderFault(f"no isolation that is strong enough works on this machine:\n{text}")


def note(mode: str) -> str:
    """What staff should know about a mode on this machine; "" where there is nothing to say."""
    if mode == "E":
        return "nothing is enforced: the verdict is indicative only"
    from . import landlock, launch

    lines = []
    if not launch.is_filtered(mode):
        lines.append(
            "no filter of system calls: bubblewrap alone holds "
            "(pip install 'photograd-course[grader]', and the system's package libseccomp2)"
        )
    if mode == "D":
        lines.append("names, sizes and times of this account's files can be seen")
    if mode in "BC" and not launch.may_change_root():
        lines.append("no right to change the root folder: names, sizes and times can be seen")
        if landlock.version() == 0:
            lines.append(f"no Landlock: what everybody may read can be read, perhaps {COURSE}")
    return "; ".join(lines)
