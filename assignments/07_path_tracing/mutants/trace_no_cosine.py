"""The cosine is missing where a path goes on."""

TASKS = ("07.5",)
LOSES = (
    "07.5.furnace",
    "07.5.hidden",
)
REPLACE = [
    (
        'share = dot(wi, hit["normals"]) / np.where(pdf > 0, pdf, 1.0)',
        "share = 1 / np.where(pdf > 0, pdf, 1.0)",
    ),
]
