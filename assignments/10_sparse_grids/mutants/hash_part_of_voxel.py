"""Voxels that share one index are taken for the same; all three must agree."""

TASKS = ("10.3",)
LOSES = ("10.3.found", "10.3.hidden")
REPLACE = [("(entry[:3] == voxel).all()", "(entry[:3] == voxel).any()")]
