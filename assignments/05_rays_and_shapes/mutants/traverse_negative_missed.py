"""For directions below 0 entry and exit are exchanged, and the box is missed."""

TASKS = ("05.6",)
LOSES = ("05.6.nearest", "05.6.axes", "05.6.cost", "05.6.growth", "05.6.embree", "05.6.hidden")
REPLACE = [
    (
        "near, far = max(faces.min(axis=0).max(), 0.0), faces.max(axis=0).min()",
        "near, far = max(faces[0].max(), 0.0), faces[1].min()",
    )
]
