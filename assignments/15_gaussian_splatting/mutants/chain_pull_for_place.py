"""pull goes to densify alone: the way back takes d_mean2d."""

TASKS = ("15.5",)
LOSES = ("15.5.differences", "15.5.hidden")
REPLACE = [("lens_back(d_mean2d, d_cov2d)", 'lens_back(found["pull"], d_cov2d)')]
