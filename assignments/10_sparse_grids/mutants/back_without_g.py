"""The weights are added up without the derivative of each sample."""

TASKS = ("10.4",)
LOSES = ("10.4.transpose", "10.4.picture", "10.4.hidden")
REPLACE = [("parts = weight[:, :, None] * g", "parts = weight[:, :, None] * np.ones(g.shape)")]
