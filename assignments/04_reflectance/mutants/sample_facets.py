"""You return facets: mirror wo at them."""

TASKS = ("04.4",)
LOSES = ("04.4.chi", "04.4.mean", "04.4.hidden")
REPLACE = [("return 2 * np.sum(wo * h, axis=1, keepdims=True) * h - wo", "return h")]
