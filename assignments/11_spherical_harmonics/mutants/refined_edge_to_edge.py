"""You stretch the grid so that the outermost values meet: the cube stays, cells are halved."""

TASKS = ("11.6",)
LOSES = ("11.6.refine", "11.6.hidden")
REPLACE = [
    (
        ("            p = (np.stack(np.indices(fine), axis=-1).reshape(-1, 3) + 0.5) / 2 - 0.5\n"),
        (
            "            p = np.stack(np.indices(fine), axis=-1).reshape(-1, 3)\n"
            "            p = p * (np.array(density.shape) - 1) / (np.array(fine) - 1)\n"
        ),
    )
]
