"""t is in units of the direction: yours is in metres."""

TASKS = ("08.3",)
LOSES = ("08.3.faces", "08.3.inside", "08.3.hidden")
REPLACE = [
    (
        "np.where(hit, t_near, 0.0), np.where(hit, t_far, 0.0)",
        (
            "tuple(np.where(hit, t, 0.0) * np.linalg.norm(directions, axis=1) for t in "
            "(t_near, t_far))"
        ),
    )
]
