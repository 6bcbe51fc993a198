"""You add up the signs of single photographs: add derivatives, then take the sign."""

TASKS = ("09.5",)
LOSES = ("09.5.differences", "09.5.silent", "09.5.hidden")
REPLACE = [
    (
        "slope += render_adjoint(grid, *rays, d_pixels)[0][..., 3]",
        "slope += np.sign(render_adjoint(grid, *rays, d_pixels)[0][..., 3])",
    )
]
