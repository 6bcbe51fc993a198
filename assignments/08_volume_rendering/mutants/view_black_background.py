"""You go back as if the background were black: it is hidden by sigma, too."""

TASKS = ("08.6",)
LOSES = ("08.6.differences", "08.6.hidden")
REPLACE = [
    (
        ("back = composite_adjoint(extinction, shade, lengths, background, d_pixel, opaque)"),
        ("back = composite_adjoint(extinction, shade, lengths, 0 * background, d_pixel, opaque)"),
    )
]
