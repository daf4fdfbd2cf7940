"""``penink balance``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from penink_cli.ground.errors import ParameterError
from penink_cli.ground.streams import source_name, writing
from penink_cli.options.common import Finite, output_options, processors, threads_option
from penink_cli.options.inputs import only_one_standard_input, read_grey, read_lines
from penink_cli.options.layers import files_argument, read_layers
from penink_cli.options.plates import names_of, plates_option
from penink_cli.options.sheet import check_area

if TYPE_CHECKING:
    from penink_cli.ground.model import Floats, Strokes

#: By how much two sheets' sides may differ, points: hatching has the shape of a grey, lines have that of the photo.
SAME_PT = 0.5


@click.command()
@files_argument
@click.option("--plate", type=click.IntRange(1), metavar="N", help="Write the plate of the N-th FILE alone.")
@plates_option
@click.option(
    "--tone",
    "tone_files",
    type=click.Path(allow_dash=True),
    multiple=True,
    metavar="FILE",
    help="The plate, made by separate, that a FILE's strokes were blasted from; once for each FILE, in their order.",
)
@click.option(
    "--correct",
    is_flag=True,
    help="Write no strokes but the tone that a plate is to be blasted from anew: blasted so, plates make up for what "
    "is wrong.",
)
@click.option(
    "--gamma", type=Finite(0.05, 20), default=1.0, metavar="G", help="The --gamma that the plates were blasted with."
)
@click.option(
    "--ink",
    "ink_files",
    type=click.Path(allow_dash=True),
    multiple=True,
    metavar="FILE",
    help="Strokes of the last FILE's ink that are on the paper too, such as outlines: counted, not changed.",
)
@click.option(
    "--lines",
    "lines_file",
    type=click.Path(allow_dash=True),
    metavar="FILE",
    help="The --lines that the plates were blasted with: nothing makes up for light ones, which are to stay white.",
)
@threads_option
@output_options
def balance(
    files: tuple[str, ...],
    output: str | None,
    max_pixels: int,
    quiet: bool,
    plate: int | None,
    pattern: str | None,
    correct: bool,
    tone_files: tuple[str, ...],
    gamma: float,
    ink_files: tuple[str, ...],
    lines_file: str | None,
    threads: int | None,
) -> None:
    """Press the strokes of plates so that together they print the right colours.

    FILEs are the strokes of the plates, each blasted by itself with its --color. Each is a little wrong, and together
    they change one another's colours; widths that change by some percent set that right. With --correct the tones of
    the plates are changed instead, to be blasted anew, which serves where one pen draws all. --plates writes all
    plates, --plate one.

    \b
    penink balance --plates 'pressed-{}.jsonl' --tone blue.pgm --tone red.pgm blue.jsonl red.jsonl
    penink balance --plate 1 --correct --tone blue.pgm --tone red.pgm blue.jsonl red.jsonl -o blue-corrected.pgm
    """
    from penink_cli.formats import pgm, strokes
    from penink_cli.ground.model import GreyImage, Strokes

    files = files or ("-",)
    if (plate is None) == (pattern is None):
        raise click.UsageError("give one of --plate and --plates")
    if plate is not None and plate > len(files):
        raise click.UsageError(f"--plate {plate}: there are {len(files)} files")
    if len(tone_files) != len(files):
        raise click.UsageError(f"{len(files)} files of strokes need as many --tone, not {len(tone_files)}")
    read = (*files, *tone_files, *ink_files, *([lines_file] if lines_file else []))
    only_one_standard_input(*read)
    if correct and gamma != 1.0:
        raise click.UsageError("--correct does not go with --gamma: the tone is the one that is blasted")
    targets = [output] if pattern is None else [*names_of(pattern, len(files), output, read)]
    workers = threads or processors()
    made = _balanced(files, tone_files, gamma, ink_files, lines_file, max_pixels, workers, quiet, correct)
    for one, target in zip(made if plate is None else [made[plate - 1]], targets, strict=True):
        with writing(target, binary=correct) as out:
            if isinstance(one, Strokes):
                strokes.write(out, one)
            else:
                pgm.write(out, GreyImage.from_grey(1.0 - one))


def _balanced(
    files: Sequence[str], tone_files: Sequence[str], gamma: float, ink_files: Sequence[str], lines_file: str | None,
    max_pixels: int, workers: int, quiet: bool, correct: bool,
) -> list[Strokes] | list[Floats]:  # fmt: skip
    """The strokes of all files, balanced, or their tones corrected."""
    from penink_cli.blasting.balancing import ROUNDS, Plate, balanced, corrected
    from penink_cli.blasting.telling import told
    from penink_cli.ground.codes import of_code
    from penink_cli.ground.model import Strokes
    from penink_cli.illustration.drawing import tone_curve
    from penink_cli.options.progress import progress

    n = len(files)
    drawn = read_layers((*files, *ink_files))
    greys = [read_grey(path, max_pixels) for path in tone_files]
    check_area(drawn[0].width, drawn[0].height, max_pixels)
    for path, layer in zip((*files, *ink_files), drawn, strict=True):
        if max(abs(layer.width - drawn[0].width), abs(layer.height - drawn[0].height)) > SAME_PT:
            size = f"{layer.width:g} x {layer.height:g} pt, the first one {drawn[0].width:g} x {drawn[0].height:g}"
            raise ParameterError(f"{source_name(path)}: a sheet of {size}")
    for path, grey in zip(tone_files, greys, strict=True):
        if grey.values.shape != greys[0].values.shape:
            raise ParameterError(f"{source_name(path)}: plates of one photo have one size; this has another")
    there = Strokes.joined(drawn[n:]) if drawn[n:] else None
    lines = read_lines(lines_file, greys[0])
    tones = [tone_curve(grey, gamma) for grey in greys]
    sheet = drawn[0].width, drawn[0].height
    left = [None if lines is None else told(tone, *sheet, lines, None, workers)[0] for tone in tones]
    plates = [
        Plate(layer, of_code(layer.color or "#000000"), tones[i], there if i == n - 1 else None, left[i])
        for i, layer in enumerate(drawn[:n])
    ]
    if correct:
        return corrected(plates, drawn[0].device_dpi, workers)
    with progress(ROUNDS, "balancing", quiet) as more:
        return balanced(plates, drawn[0].device_dpi, workers, lambda: more(1))
