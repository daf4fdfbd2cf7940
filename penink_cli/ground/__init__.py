"""What all rooms stand on: nothing here knows of drawings.

model       the values that rooms hand to one another, a module a kind
streams     inputs, outputs, signals; changes: whether an input has changed since it was read
errors      what becomes one line and exit status 1
units       lengths on paper; papers: their names and sizes; pens: finer ones for small prints
rules       the names of the rules by which strokes are chosen
device      what a printer adds to a stroke
exact       functions whose last bit is the same everywhere; for kernels _compiled/real.pxd
median      median, quantile and distinct numbers
decimals    numbers as text
angles      directions on the sheet; shapes: whether two grids may be of one picture
gaussian    a low-pass of pictures
colour      sRGB's curve and CIE Lab; codes: `#rrggbb`
masks       connected parts of a mask, and distances from it
threads     work shared out among threads; turns: two things at the same time, told one after the other
recall      results remembered while `draw --watch` draws again
"""
