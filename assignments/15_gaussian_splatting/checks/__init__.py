"""Public checks of assignment 15."""
