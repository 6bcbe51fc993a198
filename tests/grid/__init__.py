"""Sparse grids: trees and hash tables."""
