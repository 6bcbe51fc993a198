"""Hidden checks of assignment 91: no file of this folder is in a kit."""
