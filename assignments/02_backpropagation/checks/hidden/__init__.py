"""Hidden checks of assignment 02: no file of this folder is in a kit."""
