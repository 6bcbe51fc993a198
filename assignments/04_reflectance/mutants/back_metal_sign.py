"""Your d_metalness has the wrong sign: more metalness is more metal."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.linear", "04.6.hidden")
REPLACE = [
    ("np.sum(d_f * (metal - dielectric), axis=1)", "np.sum(d_f * (dielectric - metal), axis=1)")
]
