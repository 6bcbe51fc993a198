"""your walk stands still once the gradient is small: Eq. (9) takes all n steps"""

TASKS = ("01.3",)
LOSES = ("01.3.contraction",)
REPLACE = [
    ("x[k] - tau * grad(x[k])", "x[k] - tau * grad(x[k]) * (np.linalg.norm(grad(x[k])) > 1e-2)")
]
