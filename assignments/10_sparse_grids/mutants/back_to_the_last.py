"""What belongs to missing voxels goes to the last voxel: index -1 is the last row."""

TASKS = ("10.4",)
LOSES = ("10.4.transpose", "10.4.missing", "10.4.picture", "10.4.hidden")
REPLACE = [("known = row >= 0", "known = row >= -1")]
