"""Your loss is a mean over voxels, your derivative that of a sum: it is XYZ times too large."""

TASKS = ("09.4",)
LOSES = ("09.4.differences", "09.4.hidden")
REPLACE = [("ahead / length / count", "ahead / length")]
