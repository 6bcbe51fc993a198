"""Public checks of assignment 03."""
