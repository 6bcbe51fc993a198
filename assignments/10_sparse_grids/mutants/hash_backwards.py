"""Slots are looked at backwards; a search goes forwards."""

TASKS = ("10.3",)
LOSES = ("10.3.found", "10.3.again", "10.3.hidden")
REPLACE = [("(slot + probe) % len(table)", "(slot - probe) % len(table)")]
