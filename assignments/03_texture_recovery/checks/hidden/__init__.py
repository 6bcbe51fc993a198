"""Hidden checks of assignment 03: no file of this folder is in a kit."""
