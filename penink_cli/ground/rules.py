"""The rules by which strokes are chosen.

A rule is a line here and its module in `blasting/rules/`.
"""

#: Name -> what it does, for the help text.
RULES = {
    "best": "true tone",
    "strict": "the paper's rule",
    "threshold": "each stroke where the tone exceeds its own",
    "engrave": "lines that swell, whatever the texture",
}
