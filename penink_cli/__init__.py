"""penink: pen-and-ink illustrations that keep their tone and their edges at any size.

The method is that of Salisbury, Anderson, Lischinski and Salesin, "Scale-Dependent
Reproduction of Pen-and-Ink Illustrations" (SIGGRAPH 96).
"""

__version__ = "0.1.0"
