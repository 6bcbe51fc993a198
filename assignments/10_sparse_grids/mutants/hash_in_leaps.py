"""Slots are looked at in leaps of three; a search takes one after the other."""

TASKS = ("10.3",)
LOSES = ("10.3.found", "10.3.again", "10.3.hidden")
REPLACE = [("(slot + probe) % len(table)", "(slot + 3 * probe) % len(table)")]
