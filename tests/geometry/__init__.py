"""Meshes and tracing."""
