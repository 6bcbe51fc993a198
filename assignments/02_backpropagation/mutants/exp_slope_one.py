"""The slope of your exponential lacks the value: it is exp(x), not 1."""

TASKS = ("02.3", "02.5")
LOSES = ("02.3.exp", "02.3.many", "02.5.expressions", "02.5.random")
REPLACE = [("return Value(grown, ((self, grown),))", "return Value(grown, ((self, 1.0),))")]
