"""Your derivative by t_z moves h as if t_x stood still: what is held depends on nothing."""

TASKS = ("15.2",)
LOSES = ("15.2.held", "15.2.hidden")
REPLACE = [
    (
        "d_z = -np.sum(d_u * u, axis=1)",
        "d_z = -np.sum(d_u * u + np.where(h == u, 0.0, d_h * h), axis=1)",
    )
]
