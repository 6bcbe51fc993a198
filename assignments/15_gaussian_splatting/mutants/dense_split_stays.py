"""Two parts take the place of what is split: it goes."""

TASKS = ("15.6",)
LOSES = ("15.6.rows", "15.6.values", "15.6.most", "15.6.hidden")
REPLACE = [(("    kept[split] = False\n"), "")]
