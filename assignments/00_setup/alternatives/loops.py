"""Scalar loops over rows and columns."""

import numpy as np


def loss_gradient(picture, photograph):
    gradient = np.zeros(picture.shape)
    for row in range(picture.shape[0]):
        for column in range(picture.shape[1]):
            gradient[row, column] = 2 * (picture[row, column] - photograph[row, column])
    return gradient / picture.size
