"""Leaves hold one thing; up to LEAF fit."""

TASKS = ("05.5",)
LOSES = ("05.5.halves",)
REPLACE = [("stop - start <= LEAF", "stop - start <= 1")]
