"""Public checks of assignment 01: descent in one and many dimensions."""
