"""The numbers drawn are multiplied by L, not by the covariance."""

TASKS = ("15.6",)
LOSES = ("15.6.values", "15.6.hidden")
REPLACE = [("np.linalg.cholesky(whole), drawn", "whole, drawn")]
