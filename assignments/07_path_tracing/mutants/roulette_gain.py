"""q is not limited to 1: bright paths lose."""

TASKS = ("07.4",)
LOSES = ("07.4.ends", "07.4.hidden")
REPLACE = [("q = beta.max(axis=1).clip(max=1.0)", "q = beta.max(axis=1)")]
