"""Where a texel is hit more than once, only the last sample counts: add, do not assign."""

TASKS = ("03.2",)
LOSES = ("03.2.transpose", "03.2.repeated", "03.2.hidden", "03.2.cost")
REPLACE = [
    ("np.add.at(d_T, (i0, j0), (1 - fv) * (1 - fu) * g)", "d_T[i0, j0] += (1 - fv) * (1 - fu) * g"),
    ("np.add.at(d_T, (i0, j1), (1 - fv) * fu * g)", "d_T[i0, j1] += (1 - fv) * fu * g"),
    ("np.add.at(d_T, (i1, j0), fv * (1 - fu) * g)", "d_T[i1, j0] += fv * (1 - fu) * g"),
    ("np.add.at(d_T, (i1, j1), fv * fu * g)", "d_T[i1, j1] += fv * fu * g"),
]
