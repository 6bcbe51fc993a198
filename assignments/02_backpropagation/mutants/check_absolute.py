"""Your error is not divided by the gradient's length: small ones are never wrong."""

TASKS = ("02.6",)
LOSES = ("02.6.rejects", "02.6.scale")
REPLACE = [("return error / scale if scale > 0.0 else 0.0", "return error")]
