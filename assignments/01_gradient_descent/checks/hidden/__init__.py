"""Hidden checks of assignment 01: no file of this folder is in a kit."""
