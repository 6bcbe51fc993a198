"""The background is missing."""

TASKS = ("15.4",)
LOSES = ("15.4.layers", "15.4.differences", "15.4.hidden")
REPLACE = [("w.T @ c + T[-1][:, None] * background", "w.T @ c")]
