"""Your facet is the point of the cap: it lies halfway from there to the viewer."""

TASKS = ("04.4",)
LOSES = ("04.4.mirror", "04.4.chi", "04.4.mean", "04.4.hidden")
REPLACE = [("h = (cap + viewer) * stretch", "h = cap * stretch")]
