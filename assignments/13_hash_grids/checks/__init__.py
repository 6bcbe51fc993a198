"""Public checks of assignment 13."""
