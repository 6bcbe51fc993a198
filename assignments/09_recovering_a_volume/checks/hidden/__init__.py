"""Hidden checks of assignment 09: no file of this folder is in a kit."""
