"""The mean on the screen pulls at t_z as well."""

TASKS = ("15.2",)
LOSES = ("15.2.differences", "15.2.held", "15.2.hidden")
REPLACE = [("d_z = -np.sum(d_u * u, axis=1)", "d_z = -np.sum((d_u - f * d_mean2d) * u, axis=1)")]
