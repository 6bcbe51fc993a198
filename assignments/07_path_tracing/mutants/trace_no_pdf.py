"""The direction in which a path goes on is not divided by its density."""

TASKS = ("07.5",)
LOSES = (
    "07.5.furnace",
    "07.5.hidden",
)
REPLACE = [
    (
        'share = dot(wi, hit["normals"]) / np.where(pdf > 0, pdf, 1.0)',
        'share = dot(wi, hit["normals"])',
    ),
]
