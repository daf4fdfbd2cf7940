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
# Names may hold quotes, parentheses, $, & and the like: nothing in a name is ever run. What make itself cannot take in one
# (white space, and : ; = | % * ? [ \ # ~) is refused by penink-photos, by name, before anything runs: rename those, or let the
# Snakefile draw them. So are two photographs of one name, such as a.png beside a.jpg, which would become one a.ps.
#
# The options of a stage, for all pictures (BLAST = --texture stipple) or for one (BLAST.camera = …). GNU make 4.2 or later.

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

PENINK_PHOTOS := png jpg jpeg tif tiff webp avif heic gif bmp pgm ppm pbm pam
PENINK_PHOTOS += PNG JPG JPEG TIF TIFF WEBP AVIF HEIC GIF BMP PGM PPM PBM PAM
penink-photos = $(call penink-checked,$(or $(1),.),$(filter-out %.preview.png %.samples.pgm %.reduced.pgm %.grey.pgm,\
                  $(wildcard $(addprefix $(or $(1),.)/*.,$(PENINK_PHOTOS)))))

# A name with a space in it comes as several words, of which one is not in the folder or no photograph.
penink-hash := \#
penink-strange := : ; = | % * ? [ \ ~ $(penink-hash)
penink-checked = $(if $(word 2,$(1)),$(error penink.mk: folder '$(1)': make cannot take white space in a name))$(strip\
  $(foreach name,$(filter-out $(1)/%,$(2)) $(filter-out $(addprefix %.,$(PENINK_PHOTOS)),$(2)),$(error penink.mk: '$(name)' is\
    part of a name in '$(1)' that has white space in it, which make cannot take: rename it))\
  $(foreach name,$(2),$(foreach character,$(penink-strange),$(if $(findstring $(character),$(name)),$(error penink.mk:\
    '$(name)': make cannot take '$(character)' in a name: rename it))))\
  $(foreach name,$(sort $(basename $(2))),$(call penink-alone,$(filter $(addprefix $(name).,$(PENINK_PHOTOS)),$(2))))$(2))
penink-alone = $(if $(word 2,$(1)),$(error penink.mk: $(1) would all become one drawing: rename all but one))

# A word of the shell, whatever is in it: in quotes where it needs any.
penink-special := ' " ` $$ & ; | < > ( ) { } [ ] * ? ! ^ ~ \ $(penink-hash)
penink-quoted = $(strip $(word 2,$(1))$(foreach character,$(penink-special),$(findstring $(character),$(1))))
penink-word = $(if $(penink-quoted),'$(subst ','\'',$(1))',$(1))

.DELETE_ON_ERROR:
.PRECIOUS: %.edges.json %.samples.pgm %.reduced.pgm %.grey.pgm %.strokes.jsonl %.ps %.svg %.pdf
.PRECIOUS: %.detect.options %.extract.options %.reduce.options %.enlarge.options %.blast.options %.to-ps.options %.to-svg.options %.to-pdf.options

# NAME.STAGE.options holds the options a stage was last run with; it gets a new date only when they change, so depending on
# it is depending on the options. It is written as make reads the recipe, of which nothing is left to be run; by the + also
# under -n and -q, which therefore tell what would be done. They make no file, though: one that is missing says enough.
penink-options = $(or $($(1).$(notdir $*)),$($(1)))
penink-differ = $(subst x$(1),,x$(2))$(subst x$(2),,x$(1))
penink-asked = $(strip $(foreach flag,n q,$(findstring $(flag),$(filter-out -%,$(firstword $(MAKEFLAGS))))))
penink-missing = $(if $(wildcard $(subst [,\[,$@)),,missing)
penink-note = $(if $(penink-missing),$(if $(penink-asked),,$(call penink-write,$(1))),$(if $(call penink-differ,$\
                $(call penink-options,$(1)),$(file <$@)),$(call penink-write,$(1))))
penink-write = $(shell mkdir -p -- $(call penink-word,$(@D)))$(file >$@,$(call penink-options,$(1)))

PENINK_FORCE:
%.detect.options: PENINK_FORCE
	+@$(call penink-note,DETECT)
%.extract.options: PENINK_FORCE
	+@$(call penink-note,EXTRACT)
%.reduce.options: PENINK_FORCE
	+@$(call penink-note,REDUCE)
%.enlarge.options: PENINK_FORCE
	+@$(call penink-note,ENLARGE)
%.blast.options: PENINK_FORCE
	+@$(call penink-note,BLAST)
%.to-ps.options: PENINK_FORCE
	+@$(call penink-note,TO_PS)
%.to-svg.options: PENINK_FORCE
	+@$(call penink-note,TO_SVG)
%.to-pdf.options: PENINK_FORCE
	+@$(call penink-note,TO_PDF)

# $(call penink-run,SUBCOMMAND,VARIABLE OF ITS OPTIONS,FILE,MORE OPTIONS): all names are words of their own, and none is taken for an option.
penink-run = $(PENINK) $(1)$(call penink-more,$(call penink-options,$(2)))$(call penink-more,$(4)) -o $(call penink-word,$@) \
  -- $(call penink-word,$(3))
penink-more = $(if $(1), $(1))
penink-edges = -e $(call penink-word,$*.edges.json)

# The stages that see the photograph, once for each of its endings.
define penink-photo-rules
%.edges.json: %.$(1) %.detect.options
	$$(call penink-alone,$$(wildcard $$(addprefix $$*.,$$(PENINK_PHOTOS))))$$(call penink-run,detect-edges,DETECT,$$<)

%.samples.pgm: %.$(1) %.edges.json %.extract.options
	$$(call penink-run,extract-samples,EXTRACT,$$<,$$(penink-edges))

%.reduced.pgm: %.samples.pgm %.$(1) %.edges.json %.reduce.options
	$$(call penink-run,reduce,REDUCE,$$<,$$(penink-edges) --photo $$(call penink-word,$$*.$(1)))
endef
$(foreach ending,$(PENINK_PHOTOS),$(eval $(call penink-photo-rules,$(ending))))

%.grey.pgm: %.reduced.pgm %.edges.json %.enlarge.options
	$(call penink-run,enlarge,ENLARGE,$<,$(penink-edges))

%.strokes.jsonl: %.grey.pgm %.edges.json %.blast.options
	$(call penink-run,blast,BLAST,$<,$(penink-edges))

%.ps: %.strokes.jsonl %.to-ps.options
	$(call penink-run,to-ps,TO_PS,$<)

%.svg: %.strokes.jsonl %.to-svg.options
	$(call penink-run,to-svg,TO_SVG,$<)

%.pdf: %.strokes.jsonl %.to-pdf.options
	$(call penink-run,to-pdf,TO_PDF,$<)

# By way of the shell's own files: Ghostscript takes % and | in a name for more than a name.
%.preview.png: %.ps
	gs -q -dSAFER -dBATCH -dNOPAUSE -dEPSCrop -dGraphicsAlphaBits=4 -sDEVICE=pnggray -r$(PREVIEW_DPI) -sOutputFile=%stdout - \
	  < $(call penink-word,$<) > $(call penink-word,$@)

.DEFAULT_GOAL := $(penink-goal-before)
