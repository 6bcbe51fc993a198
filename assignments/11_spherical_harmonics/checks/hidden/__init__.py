"""Hidden checks of assignment 11: no file of this folder is in a kit."""
