"""A ray that goes down along an axis leaves through the lower face."""

TASKS = ("10.2",)
LOSES = ("10.2.cost",)
REPLACE = [("np.where(step > 0, side[:, None], 0.0)", "side[:, None]")]
