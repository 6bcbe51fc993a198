"""you divide by the second moment itself: its square root has the unit of the gradient"""

TASKS = ("01.5",)
LOSES = ("01.5.constant", "01.5.trace", "01.5.sums")
REPLACE = [("(np.sqrt(v_hat) + eps)", "(v_hat + eps)")]
