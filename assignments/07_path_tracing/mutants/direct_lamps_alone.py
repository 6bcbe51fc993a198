"""The material's directions are left out, though lamps leave them their share."""

TASKS = ("07.3",)
LOSES = ("07.3.furnace", "07.3.hidden", "07.3.matte", "07.3.proposal")
REPLACE = [
    (
        ("for way, wanted in ((wi, chosen), (sample_brdf(drawn_by, hit, u_surface), None)):"),
        "for way, wanted in ((wi, chosen),):",
    )
]
