"""Your d_metalness forgets what the dielectric loses."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.linear", "04.6.hidden")
REPLACE = [("np.sum(d_f * (metal - dielectric), axis=1)", "np.sum(d_f * metal, axis=1)")]
