"""Assignment 03 owes what every assignment owes."""

from __future__ import annotations

from course.assignments.support import ASSIGNMENTS, AssignmentTests


class TestTextureRecovery(AssignmentTests):
    folder = ASSIGNMENTS / "03_texture_recovery"
