"""The paper's section 3: a grey image and a stroke texture to pen strokes of the same tone.

blast.blast             what is to be drawn as a task.Task, for a rule of rules/
  restoring               the tone of the photo given back to what was made sharper
  task.Begun              the sheet.Sheet with what is on it already
    telling                 telling lines: no second stroke along a dark one, none across a white one
    marks                   small dark things on bare paper, filled first
rules/                  best, or what --rule says
  solids                what is darker than hatching can be, filled
    small                   small dark things on any ground, black as a whole
    reserved                where it is not quite black: white lines along the form, hatched as a negative
    bordered                strokes along the border and beside white lines (gaps), rows within
  hatching.hatch_sheet  textures of layers: a closed loop on the tone
    thin                    a stroke along each thin dark thing
    shares                  what each layer owes
    sweep                   straight lines; or along a field:
    form                      phase → level_lines → pen_lines
    candidates              either as strokes that walls have cut (walls.cut)
    sheet.place             trimmed to the runs that help (_compiled/placing); low_pass: what the eye sees
  stroke_set            example strokes bent along a field
  engraving             lines whose width is the tone
    tracks                  where they run; joining: of ends that face each other; rims: along borders
      taking_turns            which go on where it is light
  tile                  textures of strokes by priority, the paper's own rule; scaling: those that grow with the picture
  pressure              the hand's, at last
  threshold             what a picture that draws itself does; screens is its table, constants its numbers
outlines                strokes along edges
balancing               plates of several inks looked at together: tones corrected, strokes pressed
  frame_ends              and drawn on to the frame

For all of these curves cuts and samples Béziers, curve_fitting makes them, polylines tells what lies along samples.
reach says which tones a texture can make, pens gives it finer ones for small prints.
"""
