"""Fitting: from a capture to a model, step by step, and how good and how sure the result is.

`loop` has the fit, `options` what it can be told, `model` what it leaves behind, `evaluate` the
comparison with held-out views.
"""
