"""Names that only the solution introduces occur nowhere in what students can see.

Seen are the kit, the public checks and both wheels, whole texts there: code, comments, handout.
Names that may be seen stand in the manifest's `vocabulary`; names of one or two characters are
free. Nor is a hidden check named in the kit.
"""

from __future__ import annotations

from collections.abc import Iterator

from ..assignment_build import AssignmentBuild
from ..leak_words import bound_names, words_of
from ..regions import find_regions


def check_leaked_names(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    secret = secret_names(build)
    places: dict[str, list[str]] = {}
    for path, text in seen_texts(build).items():
        for name in secret & words_of(text):
            places.setdefault(name, []).append(path)
    for name, found in sorted(places.items()):
        more = f" and {len(found) - 1} more" if len(found) > 1 else ""
        yield f"'{name}' belongs to the solution and occurs in {sorted(found)[0]}{more}"
    for check in hidden_checks(build):
        for path, text in sorted(own_texts(build).items()):
            if check in text:
                yield f"the hidden check '{check}' is named in {path}"


def hidden_checks(build: AssignmentBuild) -> list[str]:
    """Ids of the checks that students do not get."""
    return sorted(check.id for check in build.checks if check.visibility != "public")


def secret_names(build: AssignmentBuild) -> set[str]:
    """Names that the solution introduces, that the starter lacks and the vocabulary too."""
    regions = find_regions(build.source, build.module_file)
    spans = [(each.first, each.last) for each in regions if each.kind == "solution"]
    given = words_of(build.starter) | set(build.manifest.vocabulary)
    return bound_names(build.source, spans) - given


def seen_texts(build: AssignmentBuild) -> dict[str, str]:
    """All texts that students can see, by place."""
    return {**build.haystacks, **own_texts(build)}


def own_texts(build: AssignmentBuild) -> dict[str, str]:
    """The texts of the kit, by place."""
    return {
        path: data.decode("utf-8")
        for path, data in build.visible.items()
        if not path.endswith((".png", ".jpg", ".npy", ".npz"))
    }
