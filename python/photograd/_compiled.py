"""The one place that imports the compiled core, so that its absence is explained once."""

from __future__ import annotations

try:
    from photograd import _core
except ImportError as failure:
    failure.add_note(
        "photograd: the compiled core is missing. Build it with "
        "'pip install -e . --no-build-isolation' in the source tree ('./run test' installs what "
        "that needs), or install a wheel. The course (photograd_course) works without it."
    )
    raise

__all__ = ["_core"]
