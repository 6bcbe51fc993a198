"""Things that do not shine have a density as well."""

TASKS = ("07.1",)
LOSES = ("07.1.hidden", "07.1.none")
REPLACE = [
    (
        "rows = np.flatnonzero(np.isin(thing, numbers))",
        'rows = np.flatnonzero((thing >= 0) & (thing < len(scene["corners"])))',
    )
]
