"""Public checks of assignment 90."""
