"""Your adjoint adds at [column, row]; a texture is T[row, column]."""

TASKS = ("03.2",)
LOSES = ("03.2.single", "03.2.transpose", "03.2.edge", "03.2.hidden", "03.2.cost")
REPLACE = [
    ("np.add.at(d_T, (i0, j0)", "np.add.at(d_T, (j0 % height, i0 % width)"),
    ("np.add.at(d_T, (i0, j1)", "np.add.at(d_T, (j1 % height, i0 % width)"),
    ("np.add.at(d_T, (i1, j0)", "np.add.at(d_T, (j0 % height, i1 % width)"),
    ("np.add.at(d_T, (i1, j1)", "np.add.at(d_T, (j1 % height, i1 % width)"),
]
