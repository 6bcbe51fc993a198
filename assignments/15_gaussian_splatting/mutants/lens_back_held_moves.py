"""What is held does not move: outside of the limits h has no derivative."""

TASKS = ("15.2",)
LOSES = ("15.2.held", "15.2.hidden")
REPLACE = [("np.where(h == u, d_h, 0.0)", "d_h")]
