"""Packages that are installed on demand: imported where they are needed, missed with a remedy."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from photograd.errors import IoError, message


def import_extra(function: str, module: str, extra: str) -> Any:
    """The module of an optional dependency.

    Args:
        function: on whose behalf the error speaks.
        module: what is imported.
        extra: that brings it, of [project.optional-dependencies] in pyproject.toml.

    Raises:
        IoError: it is not installed; names the command that installs it.
    """
    try:
        return import_module(module)
    except ImportError as failure:
        remedy = f"pip install 'photograd[{extra}]'"
        text = message(function, module, "an installed package", "none", remedy)
        raise IoError(text) from failure
