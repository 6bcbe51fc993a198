"""Your d_metalness is the mean of the channels: their pulls add up."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.linear", "04.6.hidden")
REPLACE = [
    ("np.sum(d_f * (metal - dielectric), axis=1)", "np.mean(d_f * (metal - dielectric), axis=1)")
]
