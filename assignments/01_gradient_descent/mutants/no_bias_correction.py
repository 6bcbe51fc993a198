"""both corrections of the bias are missing: the moments begin at zero and are too small at first"""

TASKS = ("01.5",)
LOSES = ("01.5.constant", "01.5.trace", "01.5.sums")
REPLACE = [
    ("m_hat = m / (1.0 - beta1**k)", "m_hat = m"),
    ("v_hat = v / (1.0 - beta2**k)", "v_hat = v"),
]
