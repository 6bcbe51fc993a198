"""You call a texel unseen when its gradient is zero: a texel that fits has no gradient either."""

TASKS = ("03.5",)
LOSES = ("03.5.unseen",)
REPLACE = [("weight[:, :, 0] == 0", "(loss_and_grad(T0, uv, target)[1] == 0).all(axis=2)")]
