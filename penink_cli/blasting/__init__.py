"""The paper's section 3: a grey image and a stroke texture to pen strokes of the same tone.

    blast.blast             what is to be drawn as a Task, for a rule of rules/
    task.Begun              the sheet with what is on it already
      marks                 small dark things on bare paper, filled first
    rules/
      hatching.hatch_sheet  textures of layers: a closed loop on the tone
        shares              what each layer owes
        sweep, candidates   straight lines; or along a field
        form                  phase → level_lines → pen_lines
        sheet.place         trimmed to the runs that help (placing.pyx); walls cut them
        fine strokes, sheet.press
      stroke_set            example strokes bent along a field
      engraving             lines whose width is the tone
      tile                  textures of strokes by priority; the paper's own rule
      threshold             what a picture that draws itself does; screens is its table
    outlines                strokes along edges
"""
