"""A ray exactly on an edge misses: volumes that are 0 must count for both triangles."""

TASKS = ("05.2",)
LOSES = ("05.2.edges",)
REPLACE = [
    (
        "inside = ((volumes >= 0).all(axis=0) | (volumes <= 0).all(axis=0)) & (whole != 0)",
        "inside = ((volumes > 0).all(axis=0) | (volumes < 0).all(axis=0)) & (whole != 0)",
    )
]
