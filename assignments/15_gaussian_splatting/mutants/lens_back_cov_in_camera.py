"""Your d_cov is not A^T G A: where does W go?"""

TASKS = ("15.2",)
LOSES = ("15.2.differences", "15.2.held", "15.2.hidden")
REPLACE = [
    (
        "return d_t @ W, A.swapaxes(1, 2) @ G @ A",
        "return d_t @ W, (A @ W.T).swapaxes(1, 2) @ G @ (A @ W.T)",
    )
]
