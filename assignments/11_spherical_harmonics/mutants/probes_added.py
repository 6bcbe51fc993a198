"""You add the eight probes up without weights."""

TASKS = ("11.5",)
LOSES = ("11.5.constant", "11.5.lambert", "11.5.blend", "11.5.hidden")
REPLACE = [
    (
        ('    blended = np.einsum("en,enkc->nkc", weight, probes.reshape(-1, K, C)[index])\n'),
        (
            '    blended = np.einsum("en,enkc->nkc", np.ones(weight.shape), '
            "probes.reshape(-1, K, C)[index])\n"
        ),
    )
]
