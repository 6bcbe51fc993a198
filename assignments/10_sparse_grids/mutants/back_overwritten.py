"""A voxel that several samples read keeps what the last one said; all of them add up."""

TASKS = ("10.4",)
LOSES = (
    "10.4.transpose",
    "10.4.picture",
    "10.4.hidden",
)
REPLACE = [
    ("np.add.at(d_values, row[known], parts[known])", "d_values[row[known]] = parts[known]"),
]
