"""all your steps have length tau: the gradient is not to be normalised"""

TASKS = ("01.3",)
LOSES = ("01.3.rates", "01.3.stability", "01.3.contraction")
REPLACE = [("x[k] - tau * grad(x[k])", "x[k] - tau * grad(x[k]) / np.linalg.norm(grad(x[k]))")]
