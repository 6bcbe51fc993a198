"""Recover scenes from photographs by gradient descent: forward and adjoint renderers, proved."""
