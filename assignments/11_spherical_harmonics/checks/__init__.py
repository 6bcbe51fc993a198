"""Public checks of assignment 11."""
