"""You count the splat itself among what is behind it."""

TASKS = ("15.4",)
LOSES = ("15.4.differences", "15.4.hidden")
REPLACE = [(("- np.cumsum(wv, axis=0)\n"), ("- np.cumsum(wv, axis=0) + wv\n"))]
