# %% [markdown]
# # Your first gradient
# Plots an image, the photograph, and where the image is too bright or too dark.

# %%
from photograd_course import explore

explore.options()

import first_gradient as mine
import numpy as np
from matplotlib.figure import Figure

# %%
rows, columns = np.mgrid[0:48, 0:64]
photograph = np.exp(-((columns - 40) ** 2 + (rows - 22) ** 2) / 150.0)
picture = np.exp(-((columns - 26) ** 2 + (rows - 26) ** 2) / 150.0)
gradient = mine.loss_gradient(picture, photograph)
print(f"loss {mine.loss(picture, photograph):.4f}")
print(f"after one step of 600: {mine.loss(picture - 600 * gradient, photograph):.4f}")

# %%
figure = Figure(figsize=(9, 2.8), layout="constrained")
top = np.abs(gradient).max()
panels = [
    ("image", picture, {"cmap": "gray", "vmin": 0, "vmax": 1}),
    ("photograph", photograph, {"cmap": "gray", "vmin": 0, "vmax": 1}),
    ("dL/dpicture", gradient, {"cmap": "RdBu_r", "vmin": -top, "vmax": top}),
]
for k, (title, values, colors) in enumerate(panels):
    axes = figure.add_subplot(1, 3, k + 1)
    image = axes.imshow(values, interpolation="nearest", **colors)
    axes.set_title(title)
figure.colorbar(image, ax=figure.axes, label="too dark < 0 < too bright")
explore.keep_picture(figure, "gradient.png", 110)
print("gradient.png: blue where the picture is too dark, red where it is too bright")
