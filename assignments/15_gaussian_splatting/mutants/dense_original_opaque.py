"""The original is thinned as its clone is."""

TASKS = ("15.6",)
LOSES = ("15.6.values", "15.6.hidden")
REPLACE = [
    (
        "    fresh = slice(len(rows)",
        (
            '    after["opacity_logits"][: len(stay)] = gaussians["opacity_logits"][stay]\n'
            "    fresh = slice(len(rows)"
        ),
    )
]
