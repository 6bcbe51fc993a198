"""Another lamp before the one that was drawn is counted in its place."""

TASKS = ("07.3",)
LOSES = ("07.3.dark", "07.3.hidden")
REPLACE = [
    (
        'lit = (mine > 0) & (there["thing"] == wanted)',
        ("lit = mine > 0\n            mine[lit] += 0 * wanted[lit]"),
    )
]
