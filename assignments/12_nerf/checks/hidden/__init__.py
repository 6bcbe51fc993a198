"""Hidden checks of assignment 12: no file of this folder is in a kit."""
