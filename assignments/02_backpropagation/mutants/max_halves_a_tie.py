"""At a tie your maximum gives each input 1/2; here the second takes all."""

TASKS = ("02.2",)
LOSES = ("02.2.tie",)
REPLACE = [
    (
        "return Value(larger, ((self, wins), (other, 1.0 - wins)))",
        """\
wins = 0.5 if self.data == other.data else wins
        return Value(larger, ((self, wins), (other, 1.0 - wins)))""",
    )
]
