"""The proposal is not looked at."""

TASKS = ("07.3",)
LOSES = ("07.3.hidden", "07.3.proposal")
REPLACE = [("drawn_by = scene if proposal is None else proposal", "drawn_by = scene")]
