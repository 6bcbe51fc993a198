"""Files read whole, as the readers here import it; defined in `photograd_course.input_files`."""

from __future__ import annotations

from photograd_course.input_files import read_file, read_text, require_file

__all__ = ["read_file", "read_text", "require_file"]
