"""Public checks of assignment 05."""
