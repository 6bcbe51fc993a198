"""The voxels are ordered by z first; x comes first."""

TASKS = ("10.5",)
LOSES = ("10.5.pruned", "10.5.grown", "10.5.hidden")
REPLACE = [
    (
        "return np.argwhere(active).astype(np.int64)",
        "return np.argwhere(active.transpose(2, 1, 0))[:, ::-1].astype(np.int64)",
    )
]
