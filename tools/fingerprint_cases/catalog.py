"""All cases, by name."""

from __future__ import annotations

from fnmatch import fnmatchcase

from fingerprint_cases.case import Case
from fingerprint_cases.fields import march_cases, splat_cases
from fingerprint_cases.models import model_cases
from fingerprint_cases.particles import particle_cases
from fingerprint_cases.paths import path_cases


def all_cases() -> dict[str, Case]:
    """Every case, in the order in which it runs.

    Raises:
        ValueError: two cases of one name.
    """
    found: dict[str, Case] = {}
    for group in (path_cases, particle_cases, march_cases, splat_cases, model_cases):
        for case in group():
            if case.name in found:
                raise ValueError(f"two cases of the name {case.name}")
            found[case.name] = case
    return found


def selected(pattern: str | None) -> dict[str, Case]:
    """The cases whose names a pattern of the shell matches, or that contain it."""
    return {
        name: case
        for name, case in all_cases().items()
        if pattern is None or pattern in name or fnmatchcase(name, pattern)
    }
