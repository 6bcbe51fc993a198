"""You give all eight probes the same weight."""

TASKS = ("11.5",)
LOSES = ("11.5.blend", "11.5.hidden")
REPLACE = [
    (
        ('    blended = np.einsum("en,enkc->nkc", weight, probes.reshape(-1, K, C)[index])\n'),
        (
            '    blended = np.einsum("en,enkc->nkc", np.full(weight.shape, 1 / 8), '
            "probes.reshape(-1, K, C)[index])\n"
        ),
    )
]
