"""Warps."""
