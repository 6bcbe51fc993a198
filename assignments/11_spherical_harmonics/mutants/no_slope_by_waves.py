"""Your d_v leaves out that the waves depend on x and y."""

TASKS = ("11.3",)
LOSES = ("11.3.vectors", "11.3.hidden", "11.3.cost")
REPLACE = [
    (("                slope[0] += common * (plus * even[m - 1] + minus * odd[m - 1])\n"), ("")),
    (("                slope[1] += common * (minus * even[m - 1] - plus * odd[m - 1])\n"), ("")),
]
