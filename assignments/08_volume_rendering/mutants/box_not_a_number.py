"""In the plane of a face 0 is divided by 0: look at components of 0 apart from the others."""

TASKS = ("08.3",)
LOSES = ("08.3.parallel",)
REPLACE = [
    ("parallel = directions == 0\n", "parallel = np.zeros(directions.shape, dtype=bool)\n"),
    ("t_near = np.maximum(", "t_near = np.fmax("),
    (
        "np.where(hit, t_near, 0.0), np.where(hit, t_far, 0.0)",
        "np.nan_to_num(np.where(hit, t_near, 0.0)), np.where(hit, t_far, 0.0)",
    ),
]
