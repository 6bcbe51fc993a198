"""Only the slopes see the held direction: mean2d goes on."""

TASKS = ("15.2",)
LOSES = ("15.2.means", "15.2.limits", "15.2.held", "15.2.hidden")
REPLACE = [('return f * u + camera["centre"], S', 'return f * h + camera["centre"], S')]
