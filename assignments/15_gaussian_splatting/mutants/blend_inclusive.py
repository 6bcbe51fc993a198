"""T is what the splats in front let through: yours counts the splat itself."""

TASKS = ("15.4",)
LOSES = ("15.4.layers", "15.4.differences", "15.4.hidden")
REPLACE = [("w = T[:-1] * a", "w = T[1:] * a")]
