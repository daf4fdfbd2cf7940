"""`draw`: the filters run one after another in one process, each called with the words that one would type.

commands/draw             options, and what does not go together
  options.watching          again for as long as files change; or
  many.draw_all             each photo into a folder; or once:
  drawing.draw_one          the size on paper, then the filters in their order
    request.stages            what the style and the user tell each filter
    job.Job                   one drawing's chain, stages and size
    finer_pens                pens for a small print
    found                     grey; edges, and lines at the same time (Chain.together); directions
    plates                    the grey of each ink
    hatched                   strokes over the hatching, then the hatching
      balanced                  that of several inks: drawn twice, then pressed
    manifest                  or the illustration, which is packed or draws itself
      filters.Chain.run         one filter: words.words → its command → a name on the workbench
        kept.Kept                 what need not run again
"""
