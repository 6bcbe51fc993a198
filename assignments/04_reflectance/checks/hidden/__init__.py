"""Hidden checks of assignment 04: no file of this folder is in a kit."""
