"""your eps stands inside the square root: it belongs outside"""

TASKS = ("01.5",)
LOSES = ("01.5.constant", "01.5.trace", "01.5.sums")
REPLACE = [("(np.sqrt(v_hat) + eps)", "np.sqrt(v_hat + eps)")]
