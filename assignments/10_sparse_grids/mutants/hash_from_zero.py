"""The search for a free slot begins at slot 0 instead of the own slot of the voxel."""

TASKS = ("10.3",)
LOSES = ("10.3.found", "10.3.again", "10.3.hidden")
REPLACE = [("entry = table[(slot + probe) % len(table)]", "entry = table[probe]")]
