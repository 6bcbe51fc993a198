"""eps stands squared under the root."""

TASKS = ("09.4",)
LOSES = ("09.4.values", "09.4.hidden")
REPLACE = [
    (
        "length = np.sqrt(eps**2 + np.sum(ahead**2, axis=0))",
        "length = np.sqrt(eps + np.sum(ahead**2, axis=0))",
    )
]
