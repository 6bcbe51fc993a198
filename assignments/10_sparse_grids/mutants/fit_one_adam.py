"""One Adam serves all rounds; its means belong to the voxels of the first."""

TASKS = ("10.6",)
LOSES = ("10.6.chain", "10.6.start", "10.6.hidden", "10.6.topology")
REPLACE = [
    ("    for number in range(rounds):", "    adam = Adam()\n    for number in range(rounds):"),
    ("        adam = Adam()\n", ""),
]
