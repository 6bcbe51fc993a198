"""Your furnace looks from the first cosine alone."""

TASKS = ("04.1",)
LOSES = ("04.1.shapes", "04.1.hidden")
REPLACE = [("for z in cosines:", "for z in [cosines[0]] * len(cosines):")]
