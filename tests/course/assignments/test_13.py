"""Assignment 13 owes what every assignment owes; and its handout's numbers are right."""

from __future__ import annotations

from course.assignments.support import ASSIGNMENTS, AssignmentTests

FOLDER = ASSIGNMENTS / "13_hash_grids"


class TestHashGrids(AssignmentTests):
    folder = FOLDER
