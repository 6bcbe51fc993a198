"""Your weights belong to the opposite probes."""

TASKS = ("11.5",)
LOSES = ("11.5.blend", "11.5.hidden")
REPLACE = [
    (
        ('    blended = np.einsum("en,enkc->nkc", weight, probes.reshape(-1, K, C)[index])\n'),
        (
            '    blended = np.einsum("en,enkc->nkc", weight[::-1], probes.reshape(-1, K, '
            "C)[index])\n"
        ),
    )
]
