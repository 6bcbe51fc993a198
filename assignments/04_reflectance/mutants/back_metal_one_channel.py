"""Your d_metalness has the first channel alone: all channels pull on the metalness."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.linear", "04.6.hidden")
REPLACE = [("np.sum(d_f * (metal - dielectric), axis=1)", "d_f[:, 0] * (metal - dielectric)[:, 0]")]
