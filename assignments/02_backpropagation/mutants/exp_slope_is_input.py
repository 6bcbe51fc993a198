"""Your exponential notes its input as slope; it should be its value."""

TASKS = ("02.3", "02.5")
LOSES = ("02.3.exp", "02.3.many", "02.5.expressions", "02.5.random")
REPLACE = [("return Value(grown, ((self, grown),))", "return Value(grown, ((self, self.data),))")]
