"""What all rooms stand on: nothing here knows of drawings.

model       the values that rooms hand to one another, a module a kind
streams     inputs, outputs, signals; changes: whether an input has changed since
errors      what becomes one line and exit status 1
units       lengths on paper; papers: their names and sizes; pens: finer ones for small prints
rules       the names of the rules by which strokes are chosen
device      what a printer adds to a stroke
exact       functions whose last bit is the same everywhere; for kernels _compiled/real.pxd; median
decimals    numbers as text
angles      directions on the sheet; shapes: whether two grids may be of one picture
gaussian    a low-pass of pictures
colour      sRGB's curve and CIE Lab; codes: `#rrggbb`
masks       parts of a mask that hang together, and distances
threads     bands of work shared out
recall      what is made of the same things twice, remembered while a drawing follows its files
"""
