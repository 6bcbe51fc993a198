"""Hidden checks of assignment 07: no file of this folder is in a kit."""
