"""What `check` says of earlier modules, before it comes to the assignment itself."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console
from rich.text import Text

from ..assignment.manifest import Manifest
from .brought_checks import Culprit, Looked
from .comparing import Difference
from .terminal import OutcomePrinter


def print_brought(
    looked: Looked, manifest: Manifest, differences: Sequence[Difference], console: Console
) -> None:
    """Which earlier modules pass their own checks, and which function of them is wrong.

    Args:
        looked: what was found.
        manifest: of the assignment that brings them.
        differences: of the copies here from the files of their origins.
        console: to print to.
    """

    def say(text: str, color: str = "default") -> None:
        console.print(Text(text, style=color), soft_wrap=True)

    for owner, count in looked.right:
        checks = "1 check" if count == 1 else f"{count} checks"
        say(f"✓ {owner.module}.py of {owner.id}: what is used here passes its {checks}", "green")
    for owner in looked.unreadable:
        say(f"✗ your {owner.module}.py of {owner.id} cannot be read as Python", "red")
    for owner, names in looked.missing:
        functions = ", ".join(names)
        say(f"· your {owner.module}.py of {owner.id} is used here and lacks {functions}", "yellow")
    for each in looked.culprits:
        say(f"✗ your {each.name} of {each.owner.id} is wrong: see {each.outcome.id}", "red")
        OutcomePrinter(console, each.owner).outcome(each.outcome)
        say(f"    {_remedy(each, manifest, differences)}")


def _remedy(culprit: Culprit, manifest: Manifest, differences: Sequence[Difference]) -> str:
    update = f"'photograd course start {manifest.id} --update'"
    for each in differences:
        if each.module == culprit.owner.module and culprit.function in each.code:
            return f"the one in {each.origin.path} is another: {update} takes that"
    return f"mend it in the folder of {culprit.owner.id}, then {update} copies it here"
