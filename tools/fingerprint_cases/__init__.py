"""What `tools/fingerprints.py` computes: tables of small cases, and the arrays of each."""
