"""Hidden checks of assignment 14: no file of this folder is in a kit."""
