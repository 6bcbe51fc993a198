"""The last free slot is never used."""

TASKS = ("10.3",)
LOSES = ("10.3.found", "10.3.again", "10.3.room")
REPLACE = [("for probe in range(len(table)):", "for probe in range(len(table) - 1):")]
