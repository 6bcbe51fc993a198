"""Hidden checks of assignment 15: no file of this folder is in a kit."""
