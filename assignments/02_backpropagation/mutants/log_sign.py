"""The slope of your logarithm has the wrong sign: a logarithm rises."""

TASKS = ("02.3", "02.5")
LOSES = ("02.3.log", "02.3.many", "02.5.expressions", "02.5.random")
REPLACE = [("1.0 / self.data),))", "-1.0 / self.data),))")]
