"""Hidden checks of assignment 13: no file of this folder is in a kit."""
