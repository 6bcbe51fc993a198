"""Hidden checks of assignment 05: no file of this folder is in a kit."""
