"""In x * x your product notes x once; it is used twice, with slope x each."""

TASKS = ("02.1", "02.5")
LOSES = ("02.1.square", "02.5.worked")
REPLACE = [
    (
        "return Value(self.data * other.data, ((self, other.data), (other, self.data)))",
        """\
uses = ((self, other.data), (other, self.data))
        return Value(self.data * other.data, uses[:1] if other is self else uses)""",
    )
]
