"""your result is a forward difference: its error falls with eps, not with eps squared"""

TASKS = ("01.1",)
LOSES = ("01.1.quadratic", "01.1.order", "01.1.cubic")
REPLACE = [("f(x + step) - f(x - step)) / (2.0 * eps)", "f(x + step) - f(x)) / eps")]
