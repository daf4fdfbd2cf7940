# penink.mk: pattern rules from any photograph NAME.jpg, NAME.png … to NAME.ps, .svg, .pdf and .preview.png.
#
# Include it in a Makefile of your own and ask for NAME.ps, NAME.svg or NAME.pdf; $(call penink-photos,FOLDER) is a list of
# the photographs in a folder, without the pictures that these rules write there:
#
#   include samples/penink.mk
#   BLAST = --texture stipple --width 6in
#   all: $(addsuffix .ps,$(basename $(call penink-photos,holiday)))
#
# The default goal stays what it was. Each stage writes a file, so that make -j works and a changed option remakes only what
# follows from it:
#
#   NAME.edges.json   NAME.samples.pgm   NAME.reduced.pgm   NAME.grey.pgm   NAME.strokes.jsonl   NAME.ps
#
# Make takes a space for the end of a name: photographs with spaces in theirs must be renamed, or drawn by the Snakefile.
#
# The options of a stage, for all pictures (BLAST = --texture stipple) or for one (BLAST.camera = …):

penink-goal-before := $(.DEFAULT_GOAL)

PENINK  ?= penink
DETECT  ?=
EXTRACT ?=
REDUCE  ?= --factor 4
ENLARGE ?= --scale 8 --soften
BLAST   ?= --texture crosshatch --width 4in
TO_PS   ?=
TO_SVG  ?=
TO_PDF  ?=
PREVIEW_DPI ?= 150

PENINK_PHOTOS := png jpg jpeg tif tiff webp pgm ppm PNG JPG JPEG TIF TIFF WEBP PGM PPM
penink-photos = $(filter-out %.preview.png %.samples.pgm %.reduced.pgm %.grey.pgm,\
                  $(wildcard $(addprefix $(or $(1),.)/*.,$(PENINK_PHOTOS))))

.DELETE_ON_ERROR:
.PRECIOUS: %.edges.json %.samples.pgm %.reduced.pgm %.grey.pgm %.strokes.jsonl %.ps %.svg %.pdf
.PRECIOUS: %.detect.options %.extract.options %.reduce.options %.enlarge.options %.blast.options %.to-ps.options %.to-svg.options %.to-pdf.options

# NAME.STAGE.options holds the options a stage was last run with; it gets a new date only when they
# change, so depending on it is depending on the options.
penink-options = $(or $($(1).$(notdir $*)),$($(1)))
penink-note = @mkdir -p $(@D); printf '%s\n' '$(call penink-options,$(1))' | cmp -s - $@ || printf '%s\n' '$(call penink-options,$(1))' > $@

PENINK_FORCE:
%.detect.options: PENINK_FORCE
	$(call penink-note,DETECT)
%.extract.options: PENINK_FORCE
	$(call penink-note,EXTRACT)
%.reduce.options: PENINK_FORCE
	$(call penink-note,REDUCE)
%.enlarge.options: PENINK_FORCE
	$(call penink-note,ENLARGE)
%.blast.options: PENINK_FORCE
	$(call penink-note,BLAST)
%.to-ps.options: PENINK_FORCE
	$(call penink-note,TO_PS)
%.to-svg.options: PENINK_FORCE
	$(call penink-note,TO_SVG)
%.to-pdf.options: PENINK_FORCE
	$(call penink-note,TO_PDF)

# The stages that see the photograph, once for each of its endings.
define penink-photo-rules
%.edges.json: %.$(1) %.detect.options
	$$(PENINK) detect-edges $$(call penink-options,DETECT) -o $$@ $$<

%.samples.pgm: %.$(1) %.edges.json %.extract.options
	$$(PENINK) extract-samples $$(call penink-options,EXTRACT) -e $$*.edges.json -o $$@ $$<

%.reduced.pgm: %.samples.pgm %.$(1) %.edges.json %.reduce.options
	$$(PENINK) reduce $$(call penink-options,REDUCE) -e $$*.edges.json --photo $$*.$(1) -o $$@ $$<
endef
$(foreach ending,$(PENINK_PHOTOS),$(eval $(call penink-photo-rules,$(ending))))

%.grey.pgm: %.reduced.pgm %.edges.json %.enlarge.options
	$(PENINK) enlarge $(call penink-options,ENLARGE) -e $*.edges.json -o $@ $<

%.strokes.jsonl: %.grey.pgm %.edges.json %.blast.options
	$(PENINK) blast $(call penink-options,BLAST) -e $*.edges.json -o $@ $<

%.ps: %.strokes.jsonl %.to-ps.options
	$(PENINK) to-ps $(call penink-options,TO_PS) -o $@ $<

%.svg: %.strokes.jsonl %.to-svg.options
	$(PENINK) to-svg $(call penink-options,TO_SVG) -o $@ $<

%.pdf: %.strokes.jsonl %.to-pdf.options
	$(PENINK) to-pdf $(call penink-options,TO_PDF) -o $@ $<

%.preview.png: %.ps
	gs -q -dSAFER -dBATCH -dNOPAUSE -dEPSCrop -dGraphicsAlphaBits=4 -sDEVICE=pnggray -r$(PREVIEW_DPI) -sOutputFile=$@ $<

.DEFAULT_GOAL := $(penink-goal-before)
