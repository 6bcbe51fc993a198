"""Hidden checks of assignment 00: no file of this folder is in a kit."""
