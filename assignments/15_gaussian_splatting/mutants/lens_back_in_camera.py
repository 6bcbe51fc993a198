"""Your d_means is in the camera's frame: turn it back into the world."""

TASKS = ("15.2",)
LOSES = ("15.2.differences", "15.2.held", "15.2.hidden")
REPLACE = [("return d_t @ W, A", "return d_t, A")]
