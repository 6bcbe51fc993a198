"""your result is twice the derivative: the two points lie 2 eps apart"""

TASKS = ("01.1",)
LOSES = ("01.1.quadratic", "01.1.order", "01.1.cubic")
REPLACE = [("/ (2.0 * eps)", "/ eps")]
