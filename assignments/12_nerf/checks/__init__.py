"""Public checks of assignment 12, a file for each task."""
