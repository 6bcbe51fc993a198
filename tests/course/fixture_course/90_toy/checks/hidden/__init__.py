"""Hidden checks of assignment 90: no file of this folder is in a kit."""
