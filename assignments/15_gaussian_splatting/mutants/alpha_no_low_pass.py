"""LOW_PASS is missing."""

TASKS = ("15.3",)
LOSES = ("15.3.round", "15.3.ellipse", "15.3.cuts", "15.3.hidden")
REPLACE = [("S = cov2d + np.array([LOW_PASS, 0, LOW_PASS])", "S = cov2d + np.array([0.0, 0, 0])")]
