"""Public checks of assignment 06."""
