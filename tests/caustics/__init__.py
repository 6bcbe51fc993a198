"""Chains of specular surfaces and the design of caustics."""
