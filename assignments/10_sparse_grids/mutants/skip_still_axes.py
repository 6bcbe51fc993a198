"""Where s_a = 0 there is no face ahead: ignore that axis."""

TASKS = ("10.2",)
LOSES = ("10.2.cost",)
REPLACE = [("np.where(step == 0, np.inf, (face - here) / step)", "(face - here) / step")]
