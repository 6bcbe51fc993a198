"""The cosine is missing where a path goes on."""

TASKS = ("07.5",)
LOSES = ("07.5.corner", "07.5.furnace", "07.5.hidden")
REPLACE = [
    (
        "share = np.divide(cos, pdf, out=np.zeros(len(pdf)), where=pdf > 0)",
        "share = np.divide(1, pdf, out=np.zeros(len(pdf)), where=pdf > 0)",
    )
]
