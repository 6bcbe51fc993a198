"""Hidden checks of assignment 06: no file of this folder is in a kit."""
