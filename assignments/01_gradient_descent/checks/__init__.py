"""Public checks of assignment 01: gradient descent in one and many dimensions."""
