"""Hidden checks of assignment 08: no file of this folder is in a kit."""
