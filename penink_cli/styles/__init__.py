"""The styles that come with the program, a `*.style.json` file each.

One file makes a style: `options/styles.py` finds it by its name. What it does not say, the filter's own default says.
`draw` takes `house` where no style is named (`STYLE_NAME` in `commands/draw.py`).
"""
