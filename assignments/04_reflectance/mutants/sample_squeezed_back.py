"""You divide where equation (16) multiplies: normals go by the inverse."""

TASKS = ("04.4",)
LOSES = ("04.4.mirror", "04.4.chi", "04.4.mean", "04.4.hidden")
REPLACE = [("h = (cap + viewer) * stretch", "h = (cap + viewer) / stretch")]
