"""The rasterizer and the derivatives of silhouettes."""
