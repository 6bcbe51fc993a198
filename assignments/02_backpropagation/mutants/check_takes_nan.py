"""Not a number passes: comparisons with it are false, so ask for finite ones first."""

TASKS = ("02.6",)
LOSES = ("02.6.not_finite",)
REPLACE = [
    (
        """\
    if not math.isfinite(error + scale):
        return math.inf
""",
        "",
    )
]
