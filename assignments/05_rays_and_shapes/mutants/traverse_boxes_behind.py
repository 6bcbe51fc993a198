"""Boxes that lie wholly behind the origin are entered."""

TASKS = ("05.6",)
LOSES = ("05.6.cost", "05.6.hidden")
REPLACE = [
    (
        "near, far = max(faces.min(axis=0).max(), 0.0), faces.max(axis=0).min()",
        "near, far = faces.min(axis=0).max(), faces.max(axis=0).min()",
    )
]
