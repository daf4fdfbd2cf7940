"""What subcommands share. Only this room, `main`, `chain` and `commands` know click.

common        options that many have, and the types of their values
inputs        grey, edges, fields, lines and strokes, read and checked, the file named in errors
photographs   photographs, and how the user wants them read
illustrations illustrations, loose or packed
  remembered    what several filters of one process read is decoded once
textures      a texture by its name or file
styles        a style by its name or file
inks          named inks and lists of inks; plates: all plates in one call
layers        strokes files as layers; paper, colour, order, pens
colours       a colour by its code or name
composition   how a photo is composed: what compose and draw share
sheet         sizes on paper that are too large, or most likely a mistake
progress      a bar on a terminal
watching      doing a thing again when a file changes
"""
