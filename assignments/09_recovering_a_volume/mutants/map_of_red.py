"""The fourth channel is sigma: your map is that of red."""

TASKS = ("09.5",)
LOSES = ("09.5.differences", "09.5.hidden")
REPLACE = [("d_pixels)[0][..., 3]", "d_pixels)[0][..., 0]")]
