"""What is flat has a roughness of 0: subtract eps from each root."""

TASKS = ("09.4",)
LOSES = ("09.4.values", "09.4.hidden")
REPLACE = [("np.sum(length - eps)", "np.sum(length)")]
