"""A lower limit for q keeps black paths alive."""

TASKS = ("07.4",)
LOSES = ("07.4.ends", "07.4.hidden", "07.4.values")
REPLACE = [("q = beta.max(axis=1).clip(max=1.0)", "q = beta.max(axis=1).clip(0.05, 1.0)")]
