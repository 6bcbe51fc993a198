"""your step is eps times |x|; it should be eps itself"""

TASKS = ("01.1",)
LOSES = ("01.1.cubic",)
REPLACE = [
    ("step[i] = eps", "step[i] = eps * max(1.0, abs(x[i]))"),
    ("/ (2.0 * eps)", "/ (2.0 * step[i])"),
]
