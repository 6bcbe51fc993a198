"""You take the nearest probe instead of blending eight."""

TASKS = ("11.5",)
LOSES = ("11.5.blend", "11.5.hidden")
REPLACE = [
    (
        ('    blended = np.einsum("en,enkc->nkc", weight, probes.reshape(-1, K, C)[index])\n'),
        (
            '    blended = np.einsum("en,enkc->nkc", (weight == weight.max(axis=0)) / '
            "np.sum(weight == weight.max(axis=0), axis=0), probes.reshape(-1, K, "
            "C)[index])\n"
        ),
    )
]
