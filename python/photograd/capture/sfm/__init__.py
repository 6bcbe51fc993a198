"""Structure from motion: a capture with cameras and points from nothing but photographs.

The work is pycolmap's [Schoenberger2016], behind one door (`engine`); this package prepares the
photographs, runs the stages so that they can be interrupted, and says how it went.
"""
