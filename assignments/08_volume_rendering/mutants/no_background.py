"""What shines through from behind is missing: add T_end times the background."""

TASKS = ("08.1",)
LOSES = ("08.1.constant", "08.1.slabs", "08.1.weights", "08.1.hidden")
REPLACE = [
    (
        ('return np.einsum("rs,rsc->rc", w, color) + T_end[:, None] * background, T_end'),
        'return np.einsum("rs,rsc->rc", w, color), T_end',
    )
]
