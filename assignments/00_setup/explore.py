# %% [markdown]
# # Your first gradient
# Plots an image, the photograph, and where the image is too bright or too dark: Figure 1 of the
# handout, by your function.

# %%
from photograd_course import explore

explore.options()

import importlib

import first_gradient as mine

figure_1 = importlib.import_module("data.figure_1")

# %%
picture, photograph, _ = figure_1.pictures()
gradient = mine.loss_gradient(picture, photograph)
print(f"loss {mine.loss(picture, photograph):.4f}")
print(f"after one step of 600: {mine.loss(picture - 600 * gradient, photograph):.4f}")

# %%
figure, _ = figure_1.draw(mine)
explore.keep_picture(figure, "gradient.png", 110)
print("gradient.png: blue where the picture is too dark, red where it is too bright")
