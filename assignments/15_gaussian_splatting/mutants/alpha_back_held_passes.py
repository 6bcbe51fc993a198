"""Where ALPHA_MAX holds alpha, nothing moves it: your derivative passes."""

TASKS = ("15.3",)
LOSES = ("15.3.cuts", "15.3.differences", "15.3.hidden")
REPLACE = [("np.where(seen & (raw <= ALPHA_MAX), raw", "np.where(seen, raw")]
