"""Your adjoint gives everything to one texel instead of four."""

TASKS = ("03.2",)
LOSES = ("03.2.single", "03.2.transpose", "03.2.hidden", "03.2.cost")
REPLACE = [
    (
        "(across - j0)[:, None], (down - i0)[:, None]",
        "np.rint(across - j0)[:, None], np.rint(down - i0)[:, None]",
    )
]
