"""Rows that are not drawn keep their place, with zeros."""

TASKS = ("15.5",)
LOSES = ("15.5.behind", "15.5.hidden")
REPLACE = [("rows[key][drawn] = each", "rows[key][: len(each)] = each")]
