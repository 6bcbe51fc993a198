"""Nothing is hidden in your picture: a splat counts alpha times T."""

TASKS = ("15.4",)
LOSES = ("15.4.layers", "15.4.differences", "15.4.hidden")
REPLACE = [("w = T[:-1] * a", "w = 1 * a")]
