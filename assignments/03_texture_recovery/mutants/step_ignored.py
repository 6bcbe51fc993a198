"""Your step is 0.95 itself, whatever the curvature."""

TASKS = ("03.5",)
LOSES = ("03.5.step", "03.5.recovers")
REPLACE = [("SAFETY * 2 / largest_curvature((height, width), uv, CURVATURE_ROUNDS)", "SAFETY")]
