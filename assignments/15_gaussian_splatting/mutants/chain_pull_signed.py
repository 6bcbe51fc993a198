"""pull is what alpha_back returns last: yours is d_mean2d."""

TASKS = ("15.5",)
LOSES = ("15.5.hidden",)
REPLACE = [
    (
        '        found["quats"], found["log_scales"]',
        ('        found["pull"] = d_mean2d\n        found["quats"], found["log_scales"]'),
    )
]
