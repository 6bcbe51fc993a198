"""Public checks of assignment 10."""
