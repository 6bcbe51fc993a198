"""Only triangles seen from the other side are met; both sides count."""

TASKS = ("05.2",)
LOSES = ("05.2.inside", "05.2.misses", "05.2.edges", "05.2.hidden")
REPLACE = [
    (
        "inside = ((volumes >= 0).all(axis=0) | (volumes <= 0).all(axis=0)) & (whole != 0)",
        "inside = (volumes >= 0).all(axis=0) & (whole != 0)",
    )
]
