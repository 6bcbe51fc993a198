"""A handout as one page of HTML: mathematics as MathML, figures inside, nothing from a network.

Needs the extra `handouts` of this distribution, but only where pages are made.
"""
