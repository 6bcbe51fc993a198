"""All channels get the derivative of the first."""

TASKS = ("10.4",)
LOSES = ("10.4.transpose", "10.4.picture", "10.4.hidden")
REPLACE = [
    ("parts = weight[:, :, None] * g", "parts = weight[:, :, None] * g[:, :1] * np.ones(g.shape)")
]
