"""Each voxel gets the whole derivative of the sample; its weight is left out."""

TASKS = ("10.4",)
LOSES = ("10.4.transpose", "10.4.picture", "10.4.hidden")
REPLACE = [("parts = weight[:, :, None] * g", "parts = np.ones(weight.shape)[:, :, None] * g")]
