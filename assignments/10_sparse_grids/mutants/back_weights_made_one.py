"""The weights of the voxels that exist are made to sum to 1; going forwards they are not."""

TASKS = ("10.4",)
LOSES = ("10.4.transpose", "10.4.missing", "10.4.picture", "10.4.hidden")
REPLACE = [
    (
        "parts = weight[:, :, None] * g",
        "parts = (weight / np.maximum(np.sum(weight * known, axis=0), 1e-9))[:, :, None] * g",
    )
]
