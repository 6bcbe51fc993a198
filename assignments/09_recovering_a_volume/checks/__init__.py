"""Public checks of assignment 09."""
