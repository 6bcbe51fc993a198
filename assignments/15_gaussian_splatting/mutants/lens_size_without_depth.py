"""J is divided by the depth: far things are small."""

TASKS = ("15.2",)
LOSES = ("15.2.sampled", "15.2.differences", "15.2.held", "15.2.hidden")
REPLACE = [("A = (f / z)[:, :, None]", "A = (f + 0 * z)[:, :, None]")]
