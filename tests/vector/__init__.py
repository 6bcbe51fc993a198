"""Vector graphics: areas, strokes, gradients, files, fits."""
