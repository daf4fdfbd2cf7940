"""Illustrations that render themselves: the small representation and the code that draws it, in one file."""
