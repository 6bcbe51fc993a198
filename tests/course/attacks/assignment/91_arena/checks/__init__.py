"""Public checks of assignment 91."""
