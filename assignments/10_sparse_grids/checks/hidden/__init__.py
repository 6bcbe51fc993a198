"""Hidden checks of assignment 10: no file of this folder is in a kit."""
