"""Your gradient is divided by the number of texels instead of the number of samples."""

TASKS = ("03.3",)
LOSES = ("03.3.differences", "03.3.hidden")
REPLACE = [("2 * residual / count", "2 * residual / T[:, :, 0].size")]
