"""Adam begins anew in each step, so its means never reach back."""

TASKS = ("10.6",)
LOSES = ("10.6.first", "10.6.hidden")
REPLACE = [
    (
        "        value, d_values = loss_and_grad",
        "        adam = Adam()\n            value, d_values = loss_and_grad",
    )
]
