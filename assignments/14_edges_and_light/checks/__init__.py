"""Public checks of assignment 14, a file for each task."""
