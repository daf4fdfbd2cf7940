"""What subcommands share. Only this room, `main`, `chain` and `commands` know click.

common      options that many have, and the types of their values
inputs      what subcommands read, checked, the file named in errors
textures    a texture by its name or file; styles: a style; inks: inks; plates: all in one call
layers      strokes files as layers; paper, colour, order, pens
composition how a photo is composed: what compose and draw share
sheet       sizes on paper that cannot be meant
progress    a bar on a terminal
watching    doing a thing again when a file changes
"""
