"""Your map is that of the last photograph: derivatives of all add up."""

TASKS = ("09.5",)
LOSES = ("09.5.differences", "09.5.hidden", "09.5.scene")
REPLACE = [("slope += render_adjoint", "slope = render_adjoint")]
