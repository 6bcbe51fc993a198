"""You draw from all facets: only those that the viewer sees count."""

TASKS = ("04.4",)
LOSES = ("04.4.mirror", "04.4.chi", "04.4.mean", "04.4.hidden")
REPLACE = [("    viewer = wo * stretch\n", "    viewer = np.tile([0.0, 0.0, 1.0], (len(wo), 1))\n")]
