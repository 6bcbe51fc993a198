"""Paths that go on are not multiplied by 1 / q: the picture gets darker."""

TASKS = ("07.4",)
LOSES = ("07.4.hidden", "07.4.mean", "07.4.values")
REPLACE = [("after[alive] = beta[alive] / q[alive, None]", "after[alive] = beta[alive]")]
