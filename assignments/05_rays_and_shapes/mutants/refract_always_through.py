"""Light beyond the critical angle gets through as well."""

TASKS = ("05.3",)
LOSES = ("05.3.total", "05.3.hidden")
REPLACE = [("through = square > 0", "through = square > -np.inf")]
