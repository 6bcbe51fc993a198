"""Where alpha is dropped, nothing moves it: your derivative does not skip what the values skip."""

TASKS = ("15.3",)
LOSES = ("15.3.cuts", "15.3.hidden")
REPLACE = [("np.where(seen & (raw <= ALPHA_MAX), raw", "np.where(raw <= ALPHA_MAX, raw")]
