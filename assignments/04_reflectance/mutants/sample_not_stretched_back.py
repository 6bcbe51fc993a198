"""Your facet is not stretched back: equation (16)."""

TASKS = ("04.4",)
LOSES = ("04.4.mirror", "04.4.chi", "04.4.mean", "04.4.hidden")
REPLACE = [("h = (cap + viewer) * stretch", "h = cap + viewer")]
