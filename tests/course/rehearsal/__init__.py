"""A whole class, fabricated, handed in and graded."""
