"""Public checks of assignment 00."""
