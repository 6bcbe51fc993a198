"""You divide by the sum of the weights: a thin medium is faint."""

TASKS = ("08.1",)
LOSES = (
    "08.1.constant",
    "08.1.slabs",
    "08.1.weights",
    "08.1.extremes",
    "08.1.order",
    "08.1.hidden",
)
REPLACE = [
    (
        "T_end = np.exp(-behind[:, -1])",
        (
            "T_end = np.exp(-behind[:, -1])\n"
            "    w = w / np.maximum(np.sum(w, axis=1, keepdims=True), 1e-12)"
        ),
    )
]
