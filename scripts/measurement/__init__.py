"""What scripts/accuracy is made of: one module for each section of docs/accuracy.md, and what they share.

programs.py, where the built programs are, serves other scripts as well.
"""
