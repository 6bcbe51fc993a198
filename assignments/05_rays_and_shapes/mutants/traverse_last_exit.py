"""A box is left at the last of the three exits; it is the first."""

TASKS = ("05.6",)
LOSES = ("05.6.growth", "05.6.hidden")
REPLACE = [
    (
        "near, far = max(faces.min(axis=0).max(), 0.0), faces.max(axis=0).min()",
        "near, far = max(faces.min(axis=0).max(), 0.0), faces.max(axis=0).max()",
    )
]
