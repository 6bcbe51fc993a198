"""your derivative is that of the point before: take it where the walk stands now"""

TASKS = ("01.2",)
LOSES = ("01.2.rate", "01.2.verdict", "01.2.basins")
REPLACE = [("df(float(x[k]))", "df(float(x[max(k - 1, 0)]))")]
