"""Public checks of assignment 08."""
